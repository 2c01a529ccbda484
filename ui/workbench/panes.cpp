// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/panes.h"

#include <algorithm>
#include <array>

namespace gpo {

namespace {

// Grouped by kind, as `of_kind` expects.
// clang-format off
constexpr auto kPanes = [] {
  using enum PaneKind;
  constexpr PaneNeeds kCompared = {.compared = true};
  return std::to_array<Pane>({
    {image, "image", "Image", "The frame with its overlays", {}, false, "picture"},
    {side, "scene", "Scene", "Cameras, plane, points and cube in 3-D", {}, true},
    {side, "normals", "Normals", "The hemisphere of plane normals: cost, candidates, results",
     {.compared = true, .study = true}},
    {side, "solver", "Solver", "Cost, gradient and step over the iterations", kCompared},
    {side, "candidates", "Candidates",
     "All decompositions of the homography and why they were rejected",
     {.study = true}},
    {columns, "compare", "Compare", "The compared methods side by side on the same frame",
     kCompared},
    {drawer, "curves", "Curves", "Errors over the window length",
     {.compared = true, .lengths = true}},
    {drawer, "table", "Table", "The compared results in numbers and their differences", kCompared},
    {drawer, "residuals", "Residuals", "Histogram and RMS for each frame"},
    {drawer, "timing", "Timing", "Run time of each stage", kCompared},
    {drawer, "track", "Track", "The whole life of the selected track"},
    {drawer, "tracks", "Tracks", "All tracks of the window, to sort and select"},
    {drawer, "log", "Log", "All messages"},
    {window, "window", "Window", "The whole workbench"}});
}();
// clang-format on

constexpr std::span<const Pane> of_kind(PaneKind kind) {
  const auto first = std::ranges::find(kPanes, kind, &Pane::kind);
  return {first, std::ranges::find_if(first, kPanes.end(), [=](const Pane& pane) {
            return pane.kind != kind;
          })};
}

const Pane* find(std::span<const Pane> among, const std::string& name) {
  const auto found = std::ranges::find_if(among, [&](const Pane& pane) {
    return name == pane.key || (!name.empty() && name == pane.alias);
  });
  return found == among.end() ? nullptr : &*found;
}

}  // namespace

std::span<const Pane> panes() { return kPanes; }
std::span<const Pane> side_panes() { return of_kind(PaneKind::side); }
std::span<const Pane> drawers() { return of_kind(PaneKind::drawer); }

const Pane* find_pane(const std::string& name) { return find(panes(), name); }
const Pane* find_side_pane(const std::string& name) { return find(side_panes(), name); }
const Pane* find_drawer(const std::string& name) { return find(drawers(), name); }

std::vector<std::string> pane_names() {
  std::vector<std::string> names;
  for (const Pane& pane : panes()) {
    names.emplace_back(pane.key);
    if (*pane.alias != 0) names.emplace_back(pane.alias);
  }
  return names;
}

PaneNeeds needs_of(const Panes& panes) {
  const PaneNeeds side = panes.side->needs;
  const PaneNeeds drawer = panes.drawer == nullptr ? PaneNeeds{} : panes.drawer->needs;
  // In compare mode the columns hide the side pane and its study.
  return {.compared = panes.compare || side.compared || drawer.compared,
          .lengths = side.lengths || drawer.lengths,
          .study = (side.study && !panes.compare) || drawer.study};
}

}  // namespace gpo
