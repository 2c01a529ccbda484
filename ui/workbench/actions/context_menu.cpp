// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;
using Subject = ContextSubject;

std::string line_of_cube(const State& state, const Subject& at) {
  if (!at.ray) return "";
  const auto& inspection = state.results.inspection;
  const bool leads = inspection && inspection->window->leader == at.plane;
  const Vector3d ray = at.ray->normalized();
  return fmt::format("put-cube {:.9g} {:.9g} {:.9g}{}",
                     ray.x(),
                     ray.y(),
                     ray.z(),
                     leads ? "" : fmt::format(" {}", at.plane + 1));
}

std::string line_of_main_plane(const State& state, const Subject& at) {
  const auto& inspection = state.results.inspection;
  if (!inspection || inspection->window->leader == at.plane) return "";
  return fmt::format("main-plane {}", at.plane + 1);
}

std::string line_of_main_plane_of_track(const State& state, const Subject& at) {
  const auto& inspection = state.results.inspection;
  const auto plane = inspection ? to_main_plane(*inspection, at.track) : std::nullopt;
  return plane ? fmt::format("main-plane {}", *plane) : "";
}

std::string line_of_exclusion(const State& state, const Subject& at) {
  const bool excluded = std::ranges::count(state.document.settings.exclude, at.track) > 0;
  return excluded ? "" : fmt::format("exclude {}", at.track);
}

/// Returns the line if there are two points, picked or of tracks, and a result.
std::string with_two_points(const State& state, const char* line) {
  const Selection& selection = state.selection;
  const bool two = selection.points_px.size() == 2 || selection.tracks.size() == 2;
  return two && state.results.inspection ? line : "";
}

std::string line_of_removal(const State& state, const Subject& /*at*/) {
  return state.document.settings.mask.areas.empty() ? "" : "mask off";
}

std::string copy_of(const std::string& text) {
  return text.empty() ? "" : "copy " + as_argument(text);
}

// clang-format off
constexpr auto kEntries = std::to_array<ContextEntry>({
    {ContextKind::track, "Why, and its whole life",
     [](const State&, const Subject& at) { return fmt::format("explain-track {}", at.track); }},
    {ContextKind::track, "Exclude it", line_of_exclusion},
    {ContextKind::track, "Make its plane the main one", line_of_main_plane_of_track},
    {ContextKind::track, "Go to its first frame",
     [](const State&, const Subject& at) { return fmt::format("first-of-track {}", at.track); }},
    {ContextKind::track, "Go to its last frame",
     [](const State&, const Subject& at) { return fmt::format("last-of-track {}", at.track); }},
    {ContextKind::track, "Copy it as CSV",
     [](const State&, const Subject& at) { return fmt::format("copy-track {}", at.track); }},
    {ContextKind::plane, "Make it the main plane", line_of_main_plane},
    {ContextKind::plane, "Put the cube here", line_of_cube},
    {ContextKind::point, "Pick this point (Alt+click)",
     [](const State&, const Subject& at) {
       return fmt::format("pick {:.2f} {:.2f}", at.raw_px.x(), at.raw_px.y());
     }},
    {ContextKind::point, "Set the scale from two points ...",
     [](const State& state, const Subject&) {
       return with_two_points(state, "palette set-scale");
     }},
    {ContextKind::point, "Set the origin and x axis",
     [](const State& state, const Subject&) { return with_two_points(state, "set-origin"); }},
    {ContextKind::number, "Copy the value",
     [](const State&, const Subject& at) { return copy_of(at.value); }},
    {ContextKind::number, "Copy with its uncertainty",
     [](const State&, const Subject& at) { return copy_of(at.uncertain); }},
    {ContextKind::frame, "Go to this frame",
     [](const State&, const Subject& at) { return fmt::format("frame {}", at.frame); }},
    {ContextKind::frame, "Start the window here",
     [](const State&, const Subject& at) { return fmt::format("window-start {}", at.frame); }},
    {ContextKind::frame, "End the window here",
     [](const State&, const Subject& at) { return fmt::format("window-end {}", at.frame); }},
    {ContextKind::frame, "Bookmark, or remove its bookmark",
     [](const State&, const Subject& at) { return fmt::format("bookmark-at {}", at.frame); }},
    {ContextKind::area, "Leave out an area ...",
     [](const State&, const Subject&) { return std::string("mask not"); }},
    {ContextKind::area, "Draw the area of the main plane ...",
     [](const State&, const Subject&) { return std::string("mask plane"); }},
    {ContextKind::area, "Remove all masks", line_of_removal},
});
// clang-format on

}  // namespace

std::span<const ContextEntry> context_entries() { return kEntries; }

std::string as_argument(const std::string& text) {
  std::ostringstream quoted;
  quoted << std::quoted(text);
  return quoted.str();
}

ContextSubject plane_subject(const Inspection& inspection,
                             int number,
                             const std::optional<Vector3d>& point) {
  const std::string title = plane_title(inspection, number);
  const bool known = estimated_plane(inspection, number) != nullptr;
  return {.kind = ContextKind::plane,
          .title = title,
          .plane = number,
          .ray = point,
          .why_not_there = fmt::format("The cube cannot move here: {} {}",
                                       title,
                                       known ? "is not in this direction" : "has no estimate")};
}

ContextSubject point_subject(const Vector2d& raw_px) {
  ContextSubject subject{.kind = ContextKind::point, .title = "Points for scale and origin"};
  subject.raw_px = raw_px;
  return subject;
}

ContextSubject track_subject(const Inspection& inspection, std::int64_t id) {
  ContextSubject subject{.kind = ContextKind::track, .title = fmt::format("Track {}", id)};
  subject.track = id;
  if (const auto column = column_of(*inspection.tracks, id))
    subject.title += ": " + track_life(inspection, *column).verdict;
  return subject;
}

}  // namespace gpo
