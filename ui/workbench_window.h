// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/gui.h"
#include "ui/panels/panels.h"

#include <memory>

#include <opencv2/core.hpp>

namespace gpo {

/// The whole user interface, one frame of it, into the framebuffer that is bound; through the Dear
/// ImGui context `gui`, of whichever OpenGL context is current. Returns what the user did.
Commands draw_workbench(const PanelInput& input,
                        cv::Size size,
                        Gui& gui,
                        Views& views,
                        double delta_seconds = Gui::kFixedFrame_s);

/// The picture of the current frame with its overlays as the state shows them, as large as the
/// recording's pictures: CV_8UC3, BGR. In the current OpenGL context, unzoomed.
cv::Mat draw_picture(const PanelInput& input, Gui& gui, Views& views);

/// The user interface with this inspection open, without a display: CV_8UC3, BGR. On the same
/// machine the same bytes every time: milliseconds are left out. Throws InputError where there is
/// no OpenGL.
cv::Mat snapshot_window(const std::shared_ptr<const Inspection>& inspection,
                        int frame,
                        cv::Size size = {1280, 720});

}  // namespace gpo
