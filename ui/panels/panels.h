// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/worker.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/workbench.h"

#include <vector>

namespace gpo {

/// What a panel may look at, besides the state.
struct PanelInput {
  const WorkbenchState& state;
  const Inspection* inspection;  ///< the last one that was finished; null: none
  const WorkerStatus& worker;
  bool timings = true;  ///< false: milliseconds are dashes, so that pictures compare
  float scale = 1;      ///< of the text: sizes for 96 dpi times this
};

// Each draws one part of the window through Dear ImGui and changes nothing.
void menu_bar(const PanelInput& input, Commands& commands);
void settings_panel(const PanelInput& input, const Rectangle& place, Commands& commands);
void results_panel(const PanelInput& input, const Rectangle& place);
void timeline_panel(const PanelInput& input, const Rectangle& place, Commands& commands);
void status_line(const PanelInput& input, const Rectangle& place);
void help_overlay(const PanelInput& input, const Rectangle& window, Commands& commands);
void empty_panel(const PanelInput& input, const Rectangle& place, Commands& commands);

}  // namespace gpo
