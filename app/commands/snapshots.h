// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/inspection/inspection.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace gpo {

/// One image of one recording.
struct ViewRequest {
  std::string view;                    ///< a name of `panes()`
  std::optional<int> frame;            ///< frame of the recording; default: the window's last
  std::optional<cv::Size> size;        ///< default: the view's own [px]
  std::optional<std::string> methods;  ///< for compare and curves, as in `evaluate`; default: all
  std::optional<std::string> lengths;  ///< for curves; default: 5 to the window's, step 5
  Settings window;                     ///< settings that no configuration names
  MethodTable table = {};
};

struct DrawnView {
  cv::Mat image;                                               ///< CV_8UC3, BGR
  bool ok = false;                                             ///< at least one method succeeded
  std::vector<std::shared_ptr<const Inspection>> inspections;  ///< for curves: the longest window
  std::vector<std::string> failures = {};                      ///< one line each, for people
};

/// Inspects and draws without a display. A view of one method throws InputError if it is stopped.
/// Throws InputError.
DrawnView draw_view(const std::shared_ptr<const Recording>& recording,
                    const ViewRequest& request,
                    const std::stop_token& stop = {});

}  // namespace gpo
