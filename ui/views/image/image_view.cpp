// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_view.h"

#include "engine/inspection/plane_names.h"
#include "engine/window/tracks.h"
#include "ui/context/theme.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/overlay/plane_style.h"
#include "ui/views/overlay/track_colors.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/image/occlusion.h"
#include "ui/views/image/image_drawing.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

constexpr int kTailFrames = 10;
constexpr double kResidualMagnification = 20;

/// One frame of one inspection on its way to the screen.
struct Canvas {
  ImDrawList& list;
  ScreenRect rect;
  const Inspection& inspection;
  int frame;  ///< in the window
  ImageMapping mapping;
  const ViewOptions& options;
  float scale;
  const ImageTexture* image;  ///< null: none

  ImVec2 at(const Vector2d& raw_px) const { return to_imgui(to_screen(mapping, raw_px)); }
  std::vector<ImVec2> at(const std::vector<Vector2d>& raw_px) const {
    std::vector<ImVec2> points;
    points.reserve(raw_px.size());
    for (const Vector2d& pixel : raw_px) points.push_back(at(pixel));
    return points;
  }
  TrackStyle look(int frame_in_window, int track) const {
    TrackStyle look = track_style(*inspection.window, frame_in_window, track);
    if (options.colors) look.rgb = options.colors->rgb(track);
    return look;
  }
  const Camera& camera() const { return inspection.recording->camera; }
  const Pose& pose() const { return inspection.initialization->cameras[frame]; }
  std::optional<CubeImage> estimated_cube() const {
    return gpo::estimated_cube(
        inspection, frame, cube_side(inspection, options.cube_side), options.cube_height_sides);
  }
  std::optional<CubeImage> true_cube() const {
    return gpo::true_cube(
        inspection, frame, cube_side(inspection, options.cube_side), options.cube_height_sides);
  }
  void polyline(const std::vector<ImVec2>& points, ImU32 color, float width) const {
    list.AddPolyline(points.data(), static_cast<int>(points.size()), color, 0, width * scale);
  }
};

void draw_tails(const Canvas& canvas) {
  const Tracks& tracks = *canvas.inspection.tracks;
  const int oldest = std::max(0, canvas.frame - kTailFrames);
  for (int track = 0; track < tracks.track_count(); ++track) {
    if (!tracks.seen(canvas.frame, track)) continue;
    const std::uint32_t rgb = canvas.look(canvas.frame, track).rgb;
    for (int i = oldest; i < canvas.frame; ++i) {
      const double age = static_cast<double>(canvas.frame - i) / kTailFrames;
      canvas.list.AddLine(canvas.at(tracks.raw_px[i].col(track)),
                          canvas.at(tracks.raw_px[i + 1].col(track)),
                          imgui_color(rgb, 0.15 + 0.6 * (1 - age)),
                          1.4F * canvas.scale);
    }
  }
}

void draw_track(const Canvas& canvas, int track) {
  const auto [sign, rgb] = canvas.look(canvas.frame, track);
  const auto& raw_px = canvas.inspection.tracks->raw_px[canvas.frame];
  draw_sign(canvas.list, sign, canvas.at(raw_px.col(track)), rgb);
}

void draw_tracks(const Canvas& canvas) {
  const Tracks& tracks = *canvas.inspection.tracks;
  for (int track = 0; track < tracks.track_count(); ++track)
    if (tracks.seen(canvas.frame, track)) draw_track(canvas, track);
}

void draw_residuals(const Canvas& canvas) {
  for (const ResidualVector& residual : residual_vectors(canvas.inspection, canvas.frame)) {
    const Vector2d tip = residual.observed_px +
                         kResidualMagnification * (residual.predicted_px - residual.observed_px);
    const ImVec2 from = canvas.at(residual.observed_px), to = canvas.at(tip);
    canvas.list.AddLine(from, to, imgui_color(Role::background, 0.5), 3.4F * canvas.scale);
    canvas.list.AddLine(from, to, imgui_color(Role::residual), 1.6F * canvas.scale);
  }
}

/// What the estimated cube's difference is told from.
std::optional<CubeImage> reference_cube(const Canvas& canvas) {
  if (auto truth = canvas.true_cube()) return truth;
  if (canvas.options.reference == nullptr) return std::nullopt;
  return gpo::estimated_cube(*canvas.options.reference,
                             canvas.frame,
                             cube_side(*canvas.options.reference, canvas.options.reference_side),
                             canvas.options.cube_height_sides);
}

bool exaggerates(const Canvas& canvas) {
  return canvas.options.show.exaggeration > 1 && reference_cube(canvas).has_value();
}

/// What is nearer than the cube comes back over it: the picture, and the tracks that say so.
void draw_occluders(const Canvas& canvas,
                    const std::array<Eigen::Vector3d, 8>& corners_w,
                    const CubeImage& cube) {
  if (canvas.image == nullptr || canvas.image->id() == nullptr) return;
  const Tracks& tracks = *canvas.inspection.tracks;
  const auto [low, high] = bounds(canvas.mapping, cube);
  for (const Occluder& occluder : occluders(canvas.inspection, canvas.frame, corners_w)) {
    canvas.list.PushClipRect(low, high, true);
    for (const auto& triangle : occluder.triangles_raw_px)
      draw_part(canvas.list, canvas.camera(), *canvas.image, canvas.mapping, triangle);
    canvas.list.PopClipRect();
    if (!canvas.options.show.tracks) continue;
    for (int track = 0; track < tracks.track_count(); ++track)
      if (tracks.seen(canvas.frame, track) &&
          plane_of_track(*canvas.inspection.window, canvas.frame, track) == occluder.plane)
        draw_track(canvas, track);
  }
}

/// As a body, or as the model that takes its place.
void draw_standing(const Canvas& canvas, const CubeImage& cube) {
  const double side = cube_side(canvas.inspection, canvas.options.cube_side);
  const auto shadow = contact_shadow(canvas.inspection, canvas.frame, side);
  const SolidModel* model = canvas.options.model.get();
  if (model == nullptr) {
    draw_body(canvas.list, canvas.mapping, cube, shadow);
  } else {
    draw_foot(canvas.list, canvas.mapping, cube, shadow);
    draw_model(canvas.list,
               canvas.mapping,
               canvas.camera(),
               canvas.pose(),
               *model,
               placed_on(*model, cube_corners(*canvas.inspection.cube, side)));
  }
  draw_occluders(
      canvas, cube_corners(*canvas.inspection.cube, side, canvas.options.cube_height_sides), cube);
}

void draw_cubes(const Canvas& canvas) {
  const ViewOptions& options = canvas.options;
  auto cube = canvas.estimated_cube();
  const auto reference =
      options.show.exaggeration > 1 ? reference_cube(canvas) : std::optional<CubeImage>();
  const bool far_off = cube && reference;
  if (far_off) cube = exaggerated(*cube, *reference, options.show.exaggeration);
  // A body would hide what it is held against.
  const bool body = !options.show.wireframe && !far_off;
  if (cube && body) draw_standing(canvas, *cube);
  if (const auto truth = canvas.true_cube(); truth && options.show.truth)
    draw_true_cube(canvas.list, canvas.mapping, *truth);
  if (cube && !body) draw_wireframe(canvas.list, canvas.mapping, *cube);
}

/// Of the frame, by its estimated pose; nothing where gravity is not known.
std::vector<std::vector<Vector2d>> horizon(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  if (!inspection.inertial || !inspection.inertial->ok || !canvas.options.show.gravity) return {};
  return horizon_in_image(canvas.camera(), canvas.pose(), -inspection.inertial->gravity_m_s2);
}

void draw_horizon(const Canvas& canvas) {
  for (const auto& piece : horizon(canvas)) {
    const std::vector<ImVec2> points = canvas.at(piece);
    canvas.polyline(points, imgui_color(Role::background, 0.5), 3.4F);
    canvas.polyline(points, imgui_color(Role::gravity), 1.4F);
  }
}

std::string counted(int count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// How many tracks are on each plane and on none.
std::vector<LegendRow> track_rows(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  const Window& window = *inspection.window;
  std::map<int, int> on_plane = {{window.leader, 0}};
  int outliers = 0;
  for (int track = 0; track < inspection.tracks->track_count(); ++track) {
    if (!inspection.tracks->seen(canvas.frame, track)) continue;
    const auto plane = plane_of_track(window, canvas.frame, track);
    ++(plane ? on_plane[*plane] : outliers);
  }
  std::vector<LegendRow> rows;
  for (const auto& [plane, count] : on_plane) {
    const bool leads = plane == window.leader;
    const std::string text = leads ? counted(count, "inlier")
                                   : fmt::format("{} on {}", count, plane_title(inspection, plane));
    const LegendRow row{Sign::circle, plane_color(window, plane), text};
    rows.insert(leads ? rows.begin() : rows.end(), row);
  }
  const std::string text = counted(outliers, "outlier");
  rows.insert(rows.end(), LegendRow{Sign::cross, color_of(Role::outlier), text});
  return rows;
}

std::vector<LegendRow> legend_rows(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  const ViewOptions& options = canvas.options;
  std::vector<LegendRow> rows;
  if (options.show.tracks)
    rows = options.colors ? legend_rows(*options.colors) : track_rows(canvas);
  const auto add = [&rows](Sign sign, Role role, std::string text) {
    rows.push_back(LegendRow{sign, color_of(role), std::move(text)});
  };
  if (inspection.initialization->ok && options.show.residuals)
    add(Sign::line, Role::residual, fmt::format("residuals × {:g}", kResidualMagnification));
  if (!horizon(canvas).empty()) add(Sign::line, Role::gravity, "horizon");
  if (options.show.cube && inspection.cube)
    add(Sign::square,
        Role::cube_base,
        options.model ? "model on the estimated plane" : "cube on the estimated plane");
  if (options.show.cube && !options.model_error.empty())
    add(Sign::none, Role::warning, options.model_error);
  if (options.show.cube && options.show.truth && canvas.true_cube())
    add(Sign::square, Role::truth, std::string("true cube, dashed"));
  if (options.show.cube && inspection.cube && exaggerates(canvas))
    add(Sign::none,
        Role::warning,
        fmt::format("cube's distance from {} × {}",
                    canvas.true_cube() ? "the true one" : "the first one",
                    options.show.exaggeration));
  return rows;
}

/// Everything that needs the frame to be in the window.
void draw_results(const Canvas& canvas) {
  const ViewOptions& options = canvas.options;
  if (options.show.tracks && options.show.tails) draw_tails(canvas);
  if (options.show.tracks) draw_tracks(canvas);
  if (options.show.residuals) draw_residuals(canvas);
  draw_horizon(canvas);
  if (options.show.cube) draw_cubes(canvas);
}

std::string heading(const Inspection& inspection, int frame, bool undistorted) {
  const auto& times = inspection.recording->timestamps_ns;
  const double seconds = static_cast<double>(times[frame] - times.front()) * 1e-9;
  return fmt::format("frame {} · {:.3f} s · {}{}",
                     frame,
                     seconds,
                     inspection.settings.options.method.row().title,
                     undistorted ? " · undistorted" : "");
}

}  // namespace

double cube_side(const Inspection& inspection, double chosen) {
  if (chosen > 0 || !inspection.cube) return chosen;
  return default_cube_side(*inspection.cube, inspection.initialization->plane.distance);
}

void draw_image_view(ImDrawList& list,
                     const ScreenRect& rect,
                     const Inspection& inspection,
                     int frame,
                     ImageTexture* image,
                     const ImageZoom& zoom,
                     const ViewOptions& options) {
  const Camera& camera = inspection.recording->camera;
  const int first = inspection.window->start, count = inspection.window->frame_count();
  const ImageMapping mapping = map_image(camera, rect, zoom, options.show.undistorted);
  const Canvas canvas{
      list, rect, inspection, frame - first, mapping, options, overlay_scale(), image};
  list.PushClipRect(to_imgui(rect.min), to_imgui(rect.min + rect.size), true);
  draw_image(list, rect, camera, image, mapping);
  const bool inside = frame >= first && frame < first + count;
  std::vector<LegendRow> rows;
  if (inside) {
    draw_results(canvas);
    rows = legend_rows(canvas);
    if (frame == first) rows.push_back({Sign::none, 0, "reference frame"});
  } else {
    rows.push_back(
        {Sign::none, 0, fmt::format("outside of the window {}–{}", first, first + count - 1)});
  }
  if (options.show.legend)
    draw_legend(
        list, rect, Corner::top_left, heading(inspection, frame, options.show.undistorted), rows);
  if (inside && !inspection.initialization->ok)
    draw_badge(
        list, rect, color_of(Role::warning), "not initialized", inspection.initialization->reason);
  list.PopClipRect();
}

Inspection nothing_to_show(std::shared_ptr<const Recording> recording) {
  Inspection nothing;
  nothing.recording = std::move(recording);
  nothing.tracks = std::make_shared<const Tracks>();
  nothing.window = std::make_shared<const Window>();
  nothing.initialization = std::make_shared<const Initialization>();
  return nothing;
}

}  // namespace gpo
