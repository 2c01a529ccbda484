// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/panels/panels.h"

#include <memory>
#include <optional>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// The whole user interface, one frame of it, into the framebuffer that is bound; through the Dear
/// ImGui context `gui`, of whichever OpenGL context is current. Returns what the user did.
Commands draw_workbench(const PanelInput& input,
                        cv::Size size,
                        Gui& gui,
                        Views& views,
                        double delta_seconds = Gui::kFixedFrame_s);

struct PaneRequest {
  std::string view;                   ///< a name of `panes()`
  std::optional<cv::Size> size = {};  ///< nullopt: as in the window, the image as recorded
  cv::Size window_size = {};
};
/// Draws one view of the state in the current OpenGL context: CV_8UC3, BGR. Throws InputError for
/// an unknown view and if there is nothing to draw yet.
cv::Mat draw_view(const PaneRequest& request, const PanelInput& input, Gui& gui, Views& views);

/// A view of the user interface with this inspection open, without a display: CV_8UC3, BGR. On the
/// same machine the same bytes every time: milliseconds are left out. Throws InputError where there
/// is no OpenGL.
cv::Mat snapshot_pane(const std::string& view,
                      const std::shared_ptr<const Inspection>& inspection,
                      int frame,
                      std::optional<cv::Size> size);

/// The same of the whole window.
cv::Mat snapshot_window(const std::shared_ptr<const Inspection>& inspection,
                        int frame,
                        cv::Size size = {1280, 720});

}  // namespace gpo
