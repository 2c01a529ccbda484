// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/panes.h"

#include <algorithm>

namespace gpo {

DrawPane scene_pane, normals_pane, solver_pane, candidates_pane;
DrawPane curves_drawer, table_drawer, residuals_drawer, timing_drawer, track_drawer, tracks_drawer,
    log_drawer;

namespace {

constexpr Pane kSidePanes[] = {
    {"scene", "Scene", "Cameras, plane, points and cube in 3-D", scene_pane, {}, true},
    {"normals",
     "Normals",
     "The hemisphere of plane normals: cost, candidates, answers",
     normals_pane,
     {.compared = true, .study = true}},
    {"solver",
     "Solver",
     "Cost, gradient and step over the iterations",
     solver_pane,
     {.compared = true}},
    {"candidates",
     "Candidates",
     "Every reading of the frame's homography, and why it was rejected",
     candidates_pane,
     {.study = true}}};

constexpr Pane kDrawers[] = {
    {"curves",
     "Curves",
     "Errors over the length of the window",
     curves_drawer,
     {.compared = true, .lengths = true}},
    {"table",
     "Table",
     "The compared results in numbers, and their differences",
     table_drawer,
     {.compared = true}},
    {"residuals", "Residuals", "Histogram, and root mean square frame by frame", residuals_drawer},
    {"timing", "Timing", "Where the time went, stage by stage", timing_drawer, {.compared = true}},
    {"track", "Track", "The whole life of the selected track", track_drawer},
    {"tracks", "Tracks", "All tracks of the window, to sort and to pick", tracks_drawer},
    {"log", "Log", "Every message", log_drawer}};

const Pane* find(std::span<const Pane> panes, const std::string& key) {
  const auto found = std::ranges::find(panes, key, &Pane::key);
  return found == panes.end() ? nullptr : &*found;
}

}  // namespace

std::span<const Pane> side_panes() { return kSidePanes; }
std::span<const Pane> drawers() { return kDrawers; }

const Pane* find_side_pane(const std::string& key) { return find(side_panes(), key); }
const Pane* find_drawer(const std::string& key) { return find(drawers(), key); }

PaneNeeds needs_of(const Panes& panes) {
  const PaneNeeds side = panes.side->needs;
  const PaneNeeds drawer = panes.drawer == nullptr ? PaneNeeds{} : panes.drawer->needs;
  // Where the columns stand in place of the side pane, its study is not seen.
  return {.compared = panes.compare || side.compared || drawer.compared,
          .lengths = side.lengths || drawer.lengths,
          .study = (side.study && !panes.compare) || drawer.study};
}

}  // namespace gpo
