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

/// A comparison of methods on one window, or on windows of several lengths from its start.
struct ComparisonRequest {
  std::optional<std::string> methods;  ///< syntax of `evaluate`; default: all of `table`
  std::optional<std::string> lengths;  ///< syntax of `evaluate`; default: 5 to the window's, step 5
  Settings window;                     ///< settings that no configuration names
  MethodTable table = {};
};

/// Returns the compared configurations in their order. Throws InputError.
std::vector<Configuration> configurations_of(const ComparisonRequest& request);

/// One image of one recording.
struct ViewRequest {
  std::string view;              ///< a name of `panes()`
  std::optional<int> frame;      ///< frame of the recording; default: the window's last
  std::optional<cv::Size> size;  ///< default: the view's own [px]
  ComparisonRequest compared;    ///< views of one method use only its `window`
};

struct DrawnView {
  cv::Mat image;                                               ///< CV_8UC3, BGR
  bool ok = false;                                             ///< at least one method succeeded
  std::vector<std::shared_ptr<const Inspection>> inspections;  ///< for curves: the longest window
  std::vector<std::string> failures = {};                      ///< one line each, for people
};

/// Returns the keys of all views and their other names.
std::vector<std::string> view_names();

/// Inspects and draws without a display. A view of one method throws InputError if it is stopped.
/// Throws InputError.
DrawnView draw_view(const std::shared_ptr<const Recording>& recording,
                    const ViewRequest& request,
                    const std::stop_token& stop = {});

}  // namespace gpo
