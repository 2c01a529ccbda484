// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/image/image_view.h"
#include "ui/views/scene/scene_view.h"

#include <memory>
#include <optional>

#include <opencv2/core.hpp>

namespace gpo {

/// One view of one frame (counts in the recording), drawn without a display by what the window
/// draws with: CV_8UC3, BGR. On the same machine the same bytes every time. Throws InputError where
/// there is no OpenGL.

/// As large as the recording's pictures where no size is given.
cv::Mat snapshot_image(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size = {},
                       const ViewOptions& options = {});

cv::Mat snapshot_scene(const Inspection& inspection,
                       int frame,
                       cv::Size size = {960, 720},
                       const ViewOptions& options = {});

/// The disc of normals; studies the window for it.
cv::Mat snapshot_normals(const std::shared_ptr<const Inspection>& inspection,
                         int frame,
                         cv::Size size = {720, 760});

/// At the size of `default_compare_size` where none is given.
cv::Mat snapshot_compare(Comparison inspections, int frame, std::optional<cv::Size> size = {});

}  // namespace gpo
