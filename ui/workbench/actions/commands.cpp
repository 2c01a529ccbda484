// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/commands.h"

#include "ui/workbench/actions/actions.h"

#include <algorithm>

namespace gpo {
namespace {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace

void apply(WorkbenchState& state, const Command& command) {
  const Overloaded run = {
      [&](const RunAction& c) { run_action(state, c.line); },
      [&](const ChangeSettings& c) { change_settings(state, c.settings, c.dragging); },
      [&](const GoToFrame& c) { go_to_frame(state, c.frame); },
      [&](const SetCubeSide& c) { state.document.cube_side = std::clamp(c.side, 0.0, 2.0); },
      [&](const MoveCube& c) { move_cube(state, c.ray); },
      [&](const ZoomImage& c) { state.view.image_zoom = c.zoom; },
      [&](const ZoomCompare& c) { state.view.compare_zoom = c.zoom; },
      [&](const ZoomNormals& c) { state.view.normals_zoom = c.zoom; },
      [&](const OrbitScene& c) { state.view.orbit = c.camera; },
      [&](const FitScene&) { state.view.orbit.reset(); },
      [&](const DivideWindow& c) { state.view.division = c.division; },
      [&](const OpenPath& c) { state.requests.open = c.path; },
      [&](const HoverOver& c) { state.hover = c.hover; },
      [&](const SelectTracks& c) { state.selection = c.selection; }};
  std::visit(run, command);
}

void push(Commands& commands, const Command& command) { commands.push_back(command); }

}  // namespace gpo
