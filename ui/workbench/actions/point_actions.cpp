// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The commands that take points of the image: scale, origin, cubes.
#include "engine/base/error.h"
#include "engine/inspection/studies/studies.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

int frame_in_window(const State& state) {
  const auto& inspection = state.results.inspection;
  if (!inspection || !inspection->initialization->ok) throw InputError("no result yet");
  const int frame = state.view.frame - inspection->window->start;
  if (frame < 0 || frame >= inspection->window->frame_count())
    throw InputError("the current frame is outside of the window");
  return frame;
}

Vector2d pixel_of(const State& state, const Arguments& arguments) {
  const Camera& camera = state.document.recording->camera;
  const Vector2d raw_px(arguments.number(0), arguments.number(1));
  const Eigen::AlignedBox2d image(Vector2d(-0.5, -0.5),
                                  Vector2d(camera.width - 0.5, camera.height - 0.5));
  if (!image.contains(raw_px))
    throw InputError(fmt::format(
        "{}: ({:g}, {:g}) is outside of the image", arguments.action, raw_px.x(), raw_px.y()));
  return raw_px;
}

/// Returns the given pixels, else the picked ones, else those of the two selected tracks; the one
/// selected last comes last.
std::string point_pair(const State& state, const Arguments& arguments, std::size_t first) {
  std::vector<double> numbers;
  for (std::size_t i = first; i < arguments.size(); ++i) numbers.push_back(arguments.number(i));
  const Selection& selection = state.selection;
  int frame = state.view.frame;
  const auto add = [&](const Vector2d& raw_px) {
    numbers.insert(numbers.end(), {raw_px.x(), raw_px.y()});
  };
  if (numbers.empty() && selection.points_px.size() == 2) {
    std::ranges::for_each(selection.points_px, add);
    frame = selection.points_frame;
  } else if (numbers.empty() && selection.tracks.size() == 2 && state.results.inspection) {
    const Tracks& tracks = *state.results.inspection->tracks;
    frame = tracks.start;  // the reference frame sees all tracks
    auto ids = selection.tracks;
    if (ids.front() == selection.focus) std::swap(ids[0], ids[1]);
    for (const std::int64_t id : ids)
      if (const auto column = column_of(tracks, id)) add(tracks.raw_px[0].col(*column));
  }
  if (numbers.size() != 4)
    throw InputError(arguments.action +
                     ": pick two points with Alt+click, or select two tracks with Ctrl+click");
  numbers.push_back(frame);
  return fmt::format("{}", fmt::join(numbers, ","));
}

/// Changes the settings unless the latest result shows that the points do not serve.
void choose_points(State& state, Settings settings) {
  const auto& latest = state.results.inspection;
  if (latest && latest->initialization->ok && latest->settings.start == settings.start) {
    Inspection tried = *latest;
    tried.settings = settings;
    tried.measured_scale = measure_scale(tried);
    tried.chosen_world = choose_world(tried);
    check_chosen(tried);
  }
  change_settings(state, std::move(settings));
}

void set_scale(State& state, const Arguments& arguments) {
  Settings settings = state.document.settings;
  const bool off = arguments[0] == "off";
  for (const char* key : {"scale_points", "scale_length", "scale_length_sigma"})
    settings = with_default(std::move(settings), key);
  if (!off) {
    settings = with_setting(std::move(settings), "scale_length", arguments[0]);
    settings = with_setting(std::move(settings), "scale_points", point_pair(state, arguments, 1));
  }
  choose_points(state, std::move(settings));
  say(state,
      off ? "the scale is not from points; Ctrl+Z undoes it"
          : "all lengths are in meters by these points; Ctrl+Z undoes it");
}

void set_origin(State& state, const Arguments& arguments) {
  Settings settings = with_default(state.document.settings, "world_points");
  const bool off = !arguments.empty() && arguments[0] == "off";
  if (!off)
    settings = with_setting(std::move(settings), "world_points", point_pair(state, arguments, 0));
  choose_points(state, std::move(settings));
}

void put_cube_at_pixel(State& state, const Arguments& arguments) {
  const int frame = frame_in_window(state);
  const Inspection& inspection = *state.results.inspection;
  const Vector2d raw_px = pixel_of(state, arguments);
  const int leader = inspection.window->leader;
  const int number = plane_near(inspection, frame, raw_px).value_or(leader);
  const Plane* plane = estimated_plane(inspection, number);
  const auto to =
      plane == nullptr ? std::nullopt : point_on_plane(inspection, frame, raw_px, *plane);
  if (!to)
    throw InputError(fmt::format(
        "{}: {} is not in this direction", arguments.action, plane_title(inspection, number)));
  move_cube(state, to, number == leader ? 0 : number + 1);
}

}  // namespace

void put_cube(State& state, const Arguments& arguments) {
  if (arguments.size() == 2) return put_cube_at_pixel(state, arguments);
  const Vector3d ray(arguments.number(0), arguments.number(1), arguments.number(2));
  const int plane = arguments.size() > 3 ? arguments.whole_number(3) : 0;
  const auto& inspection = state.results.inspection;
  if (!inspection || !inspection->initialization->ok)
    throw InputError("put-cube: there is no plane to put it on");
  const int number = plane == 0 ? inspection->window->leader : plane - 1;
  const Plane* on = estimated_plane(*inspection, number);
  if (on == nullptr) throw InputError(fmt::format("put-cube: plane {} has no estimate", plane));
  if (!ray.allFinite() || !intersect(*on, inspection->initialization->cameras.front(), ray))
    throw InputError(
        fmt::format("put-cube: {} is not in this direction", plane_title(*inspection, number)));
  move_cube(state, ray, number == inspection->window->leader ? 0 : number + 1);
}

void add_point_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Edit"};
  menu.add({"move-cube",
            "Put a cube at a pixel",
            "Does the same as put-cube X Y; the name of older scripts"},
           "X Y",
           put_cube_at_pixel);
  menu.add({"pick",
            "Pick a point",
            "Picks a pixel of the current frame, of at most two, for set-scale and set-origin"},
           "X Y",
           [](State& s, const Arguments& a) { pick_point(s, pixel_of(s, a)); });
  menu.add({"set-scale",
            "Set the scale from two points",
            "Sets the metric scale by the distance [m] of two points: the picked ones (Alt+click), "
            "the two selected tracks, or pixels of the current frame; off: not from points"},
           "METERS|off [X1 [Y1 [X2 [Y2]]]]",
           set_scale);
  menu.add(
      {"set-origin",
       "Set the origin and x axis",
       "Sets the origin of exported poses and points to the first of two points and x towards "
       "the second one, chosen as for set-scale; z is set world_up; off: the reference camera"},
      "[X1|off [Y1 [X2 [Y2]]]]",
      set_origin);
}

}  // namespace gpo
