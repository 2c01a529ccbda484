// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/inspection/worker.h"
#include "ui/context/window_picture.h"
#include "ui/views/picture_texture.h"
#include "ui/views/scene_view.h"
#include "ui/workbench/layout.h"
#include "ui/workbench/workbench.h"

#include <memory>
#include <string>

namespace gpo {

/// What a panel may look at, besides the state.
struct PanelInput {
  const WorkbenchState& state;
  const Inspection* inspection;  ///< the last one that was finished; null: none
  const WorkerStatus& worker;
  bool timings = true;  ///< false: milliseconds are dashes, so that pictures compare
  float scale = 1;      ///< of the text: sizes for 96 dpi times this
};

/// What the views keep in the graphics memory from frame to frame. Needs its context.
struct Views {
  PictureTexture picture;
  std::shared_ptr<const Recording> recording;  ///< of the picture that is in `picture`
  int frame = -1;
  std::string picture_error;  ///< why there is none
  SceneView scene;
  WindowPicture window;  ///< of which only the parts that change are drawn anew
};

// Each draws one part of the window through Dear ImGui and changes nothing but `Views`.
void menu_bar(const PanelInput& input, Commands& commands);
void settings_panel(const PanelInput& input, const Rectangle& place, Commands& commands);
void results_panel(const PanelInput& input, const Rectangle& place);
void image_panel(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands);
void scene_panel(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands);
void timeline_panel(const PanelInput& input, const Rectangle& place, Commands& commands);
void status_line(const PanelInput& input, const Rectangle& place);
void help_overlay(const PanelInput& input, const Rectangle& window, Commands& commands);
void empty_panel(const PanelInput& input, const Rectangle& place, Commands& commands);

}  // namespace gpo
