// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/panels/panels.h"

namespace gpo {

/// Draws one frame of the window into the bound framebuffer, through Dear ImGui's context `gui`.
/// Returns what the user did.
Commands draw_workbench(const PanelInput& input,
                        cv::Size size,
                        Gui& gui,
                        Views& views,
                        double delta_seconds = Gui::kFixedFrame_s);

/// Dear ImGui and the caches for views in the current OpenGL context.
struct Drawing {
  Gui& gui;
  Views& views;
};

/// Returns one view of the window: CV_8UC3, BGR. `view`: a name of `panes()`; by default as large
/// as in a window of `window_size`, the image as large as in the recording. Throws InputError for
/// an unknown view, and if there is nothing to draw yet.
cv::Mat draw_view(const std::string& view,
                  std::optional<cv::Size> wanted,
                  const PanelInput& input,
                  cv::Size window_size,
                  const Drawing& drawing);

/// Returns a view with this inspection, drawn off-screen: CV_8UC3, BGR. Has no milliseconds, so on
/// one machine the bytes are always the same. Throws InputError without OpenGL.
cv::Mat snapshot_pane(const std::string& view,
                      const std::shared_ptr<const Inspection>& inspection,
                      int frame,
                      std::optional<cv::Size> size);

/// A question that must be answered first.
struct Question {
  std::string title;
  std::vector<std::string> lines;  ///< the subject, line by line
  std::string advice;
  std::string yes, no;  ///< texts of the buttons
};

/// Draws one frame with the question alone into the bound framebuffer. Returns the answer; nullopt
/// until a button is clicked. Escape means no.
std::optional<bool> ask(Gui& gui, cv::Size size, const Question& question);

}  // namespace gpo
