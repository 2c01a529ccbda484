// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/inspection/inspection.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <opencv2/core/mat.hpp>

namespace gpo {

/// A comparison of methods on one window, or on all its beginnings.
struct ComparisonRequest {
  std::optional<std::string> methods;  ///< as `evaluate` reads them; default: the methods' table
  std::optional<std::string> lengths;  ///< of the windows; default: 5 to the window's, by 5
  Settings window;                     ///< what no configuration names is as here
  MethodTable table = {};              ///< of methods
};

/// Returns the compared configurations in their order. Throws InputError.
std::vector<Configuration> configurations_of(const ComparisonRequest& request);

/// One picture of one recording.
struct ViewRequest {
  std::string view;              ///< a name of `panes()`
  std::optional<int> frame;      ///< counts in the recording; default: the window's last
  std::optional<cv::Size> size;  ///< default: the view's own [px]
  ComparisonRequest compared;    ///< its `window` are the settings of views of one method
};

/// CV_8UC3, BGR, with what it shows.
struct DrawnView {
  cv::Mat image;
  bool ok = false;  ///< what it shows could be computed; of several methods: at least one
  std::vector<std::shared_ptr<const Inspection>> inspections;  ///< of curves: of the longest window
  std::vector<std::string> failures = {};                      ///< a line each, for people
};

/// The keys of the views and their other names: all that the window has.
std::vector<std::string> view_names();

/// Inspects and draws without a display. A view of one method throws InputError where it is
/// stopped. Throws InputError.
DrawnView draw_view(const std::shared_ptr<const Recording>& recording,
                    const ViewRequest& request,
                    const std::stop_token& stop = {});

}  // namespace gpo
