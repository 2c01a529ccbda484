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

// Images of a view of a frame (counted in the recording), drawn without a display by the window's
// code: CV_8UC3, BGR. The same bytes every time on the same machine. They throw InputError without
// OpenGL.

/// By default of the size of the recording's images.
cv::Mat snapshot_image(const Inspection& inspection,
                       int frame,
                       std::optional<cv::Size> size = {},
                       const ViewOptions& options = {});

cv::Mat snapshot_scene(const Inspection& inspection,
                       int frame,
                       cv::Size size = {960, 720},
                       const ViewOptions& options = {});

/// The disc of normals, after a study of the window.
cv::Mat snapshot_normals(const std::shared_ptr<const Inspection>& inspection,
                         int frame,
                         cv::Size size = {720, 760});

/// By default of the size of `default_compare_size`.
cv::Mat snapshot_compare(Comparison inspections, int frame, std::optional<cv::Size> size = {});

}  // namespace gpo
