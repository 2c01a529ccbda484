// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/studies/studies.h"
#include "tests/ui/window_test.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/scene/scene_view.h"

namespace gpo::test {

using Eigen::Vector2d;

/// Drives image and scene of the window with the mouse.
class LinkedSelection : public WindowTest {
 protected:
  LinkedSelection() {
    open(made_inspection());
    applies_ = true;
    apply(state_, GoToFrame{kFrame});
    draw_times(3);
  }
  void point_at(const Vector2d& at) {
    WindowTest::point_at(static_cast<float>(at.x()), static_cast<float>(at.y()));
  }
  void click(const Vector2d& at, int button = 0) {
    WindowTest::click(static_cast<float>(at.x()), static_cast<float>(at.y()), button);
    draw_times(40);  // the next click is no double click
  }
  void select_rectangle(const Vector2d& a, const Vector2d& b) {
    test::hold(false, true);
    point_at(a);
    press(true);
    point_at(b);
    press(false);
    test::hold(false, false);
  }

  const ContextSubject& subject(ContextKind kind) const {
    const auto found = std::ranges::find(views_->context, kind, &ContextSubject::kind);
    return found == views_->context.end() ? throw std::out_of_range("no such menu") : *found;
  }
  /// Returns the line that an entry of the open context menu runs; empty if it is not available.
  std::string line_of_entry(ContextKind kind, const std::string& title) const {
    for (const ContextEntry& entry : context_entries())
      if (entry.kind == kind && entry.title == title) return entry.line(state_, subject(kind));
    throw std::out_of_range("no such entry");
  }
  void run_entry(ContextKind kind, const std::string& title) {
    run_line(state_, line_of_entry(kind, title));
  }

  ScreenRect image() const { return screen_rect(layout_.image); }
  Vector2d track_on_screen(int column) const {
    const ImageMapping mapping = map_image(state_.document.recording->camera,
                                           image(),
                                           state_.view.image_zoom,
                                           state_.view.toggles.undistorted);
    return to_screen(mapping, inspection_->tracks->raw_px[kFrame - kStart].col(column));
  }
  OrbitCamera camera() const {
    return default_scene_camera(
        *inspection_, cube_side(*inspection_, 0), layout_.side.width / layout_.side.height);
  }
  Vector2d on_scene(const Eigen::Vector3d& point) const {
    return *on_screen(camera(), point, screen_rect(layout_.side));
  }
  /// Returns a track that has no neighbors in the image and in the scene; -1 if there is none.
  int lonely_track() const {
    const auto& points = inspection_->initialization->points;
    const auto seen = [&](int track) { return inspection_->tracks->seen(kFrame - kStart, track); };
    for (const MapPoint& one : points) {
      bool alone = seen(one.track);
      for (int other = 0; other < inspection_->tracks->track_count() && alone; ++other)
        alone = other == one.track || !seen(other) ||
                (track_on_screen(one.track) - track_on_screen(other)).norm() > 25;
      for (const MapPoint& other : points)
        alone = alone && (other.track == one.track ||
                          (on_scene(one.position) - on_scene(other.position)).norm() > 16);
      if (alone) return one.track;
    }
    return -1;
  }

  /// Returns a point on the plane beside the cube that is far from points and cameras in the scene.
  Eigen::Vector3d free_place() const {
    const CubeAnchor& cube = *inspection_->cube;
    const Initialization& result = *inspection_->initialization;
    for (double x = -0.4; x < 0.4; x += 0.01)
      for (double y = -0.4; y < 0.4; y += 0.01) {
        const Eigen::Vector3d to = cube.origin + x * cube.axes.col(0) + y * cube.axes.col(1);
        const auto near = [&](const Eigen::Vector3d& other) {
          return (on_scene(to) - on_scene(other)).norm() < 11;
        };
        if (std::ranges::none_of(result.points, near, &MapPoint::position) &&
            std::ranges::none_of(result.cameras, near, &Pose::p_wc))
          return to;
      }
    ADD_FAILURE() << "no free place";
    return cube.origin;
  }

  static constexpr int kStart = 5, kFrame = 20;
};

}  // namespace gpo::test
