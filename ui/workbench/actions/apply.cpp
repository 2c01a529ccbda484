// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions/apply.h"

#include "ui/workbench/actions/actions.h"
#include "ui/workbench/playing.h"
#include "ui/workbench/undo.h"

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
  const auto run = [&](const RunAction& c) { run_action(state, c.line); };
  const auto change = [&](const ChangeSettings& c) {
    change_settings(state, c.settings, c.dragging);
  };
  const auto go = [&](const GoToFrame& c) { go_to_frame(state, c.frame); };
  const auto cube = [&](const SetCubeSide& c) {
    state.document.cube_side = std::clamp(c.side, 0.0, 2.0);
  };
  const auto move = [&](const MoveCube& c) { move_cube(state, c.ray); };
  const auto zoom = [&](const ZoomImage& c) { state.view.image_zoom = c.zoom; };
  const auto zoom_all = [&](const ZoomCompare& c) { state.view.compare_zoom = c.zoom; };
  const auto normals = [&](const ZoomNormals& c) { state.view.normals_zoom = c.zoom; };
  const auto orbit = [&](const OrbitScene& c) { state.view.orbit = c.camera; };
  const auto fit = [&](const FitScene&) { state.view.orbit.reset(); };
  const auto divide = [&](const DivideWindow& c) { state.view.division = c.division; };
  const auto open = [&](const OpenPath& c) { state.requests.open = c.path; };
  const auto hover = [&](const HoverOver& c) { state.hover = c.hover; };
  const auto select = [&](const SelectTracks& c) { state.selection = c.selection; };
  std::visit(Overloaded{run,
                        change,
                        go,
                        cube,
                        move,
                        zoom,
                        zoom_all,
                        normals,
                        orbit,
                        fit,
                        divide,
                        open,
                        hover,
                        select},
             command);
}

void push(Commands& commands, const Command& command) { commands.push_back(command); }

}  // namespace gpo
