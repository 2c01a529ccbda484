// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"

namespace gpo {

// The side panes and the drawers, one function each, as `panels.h` has the other parts of the
// window. Called within the panel that they fill.
void scene_pane(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands);
void normals_pane(const PanelInput& input,
                  const Rectangle& place,
                  Views& views,
                  Commands& commands);
void solver_pane(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands);
void candidates_pane(const PanelInput& input,
                     const Rectangle& place,
                     Views& views,
                     Commands& commands);

void curves_drawer(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& commands);
void table_drawer(const PanelInput& input,
                  const Rectangle& place,
                  Views& views,
                  Commands& commands);
void residuals_drawer(const PanelInput& input,
                      const Rectangle& place,
                      Views& views,
                      Commands& commands);
void timing_drawer(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& commands);
void track_drawer(const PanelInput& input,
                  const Rectangle& place,
                  Views& views,
                  Commands& commands);
void log_drawer(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands);

}  // namespace gpo
