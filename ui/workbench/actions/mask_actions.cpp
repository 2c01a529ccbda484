// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The commands that draw and remove masks of the reference frame.
#include "engine/base/error.h"
#include "engine/inspection/inspection.h"
#include "ui/workbench/actions/actions.h"

#include <fmt/format.h>

namespace gpo {
namespace {

using State = WorkbenchState;

/// Returns the effect on the tracks of the current window, for people; empty if it is unknown.
std::string effect_of(const State& state, const Mask& mask) {
  const auto& inspection = state.results.inspection;
  if (!inspection || inspection->tracks->raw_px.empty() ||
      inspection->tracks->start != state.document.settings.start)
    return "";
  const Tracks& tracks = *inspection->tracks;
  int inside = 0;
  for (int j = 0; j < tracks.track_count(); ++j)
    inside += mask.contains(tracks.raw_px[0].col(j)) ? 1 : 0;
  return counted(inside, "track") + (mask.kind == MaskKind::leave_out
                                         ? " left out"
                                         : " may be on plane 1, all others may not");
}

/// Without pixels the mouse draws the mask.
void add_mask(State& state, MaskKind kind, const Arguments& arguments) {
  if (arguments.empty()) {
    go_to_frame(state, state.document.settings.start);
    state.view.drawn_mask = Mask{kind};
    return;
  }
  Mask mask{kind};
  for (std::size_t i = 0; i < arguments.size(); i += 2)
    mask.corners_raw_px.emplace_back(arguments.number(i), arguments.number(i + 1));
  const std::string before = setting_text(state.document.settings, "mask");
  const std::string after =
      (state.document.settings.mask.areas.empty() ? "" : before + "/") + mask.text();
  Settings settings = with_setting(state.document.settings, "mask", after);
  state.view.drawn_mask.reset();
  const std::string effect = effect_of(state, mask);
  say(state, "mask added" + (effect.empty() ? "" : ": " + effect) + "; Ctrl+Z undoes it");
  change_settings(state, std::move(settings));
}

void remove_masks(State& state) {
  state.view.drawn_mask.reset();
  const auto count = state.document.settings.mask.areas.size();
  if (count == 0) throw InputError("mask off: there are no masks");
  say(state, counted(count, "mask") + " removed; Ctrl+Z undoes it");
  change_settings(state, with_default(state.document.settings, "mask"));
}

}  // namespace

void add_mask_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Edit", "Masks"};
  menu.add({"mask not",
            "Leave out an area",
            "Leaves out the tracks in an area of the reference frame: a dragged rectangle, or a "
            "polygon of clicked corners; in scripts pixels of the recorded, distorted image"},
           "[X1 Y1 X2 Y2 ...]",
           [](State& s, const Arguments& a) { add_mask(s, MaskKind::leave_out, a); });
  menu.add({"mask plane",
            "Draw the area of the main plane",
            "Finds plane 1 only among the tracks in an area of the reference frame, and further "
            "planes only outside of it; drawn and written as for mask not"},
           "[X1 Y1 X2 Y2 ...]",
           [](State& s, const Arguments& a) { add_mask(s, MaskKind::plane, a); });
  menu.plain({"mask off", "Remove all masks", "Removes all masks and computes again"},
             remove_masks);
}

}  // namespace gpo
