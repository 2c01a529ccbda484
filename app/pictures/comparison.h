// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/experiment/figure.h"
#include "engine/inspection/inspection.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// What methods are compared on: one window, or all its beginnings.
struct ComparisonRequest {
  std::optional<std::string> methods;  ///< as `evaluate` reads them; default: the methods' table
  std::optional<std::string> lengths;  ///< of the windows; default: 5 to the window's, by 5
  Settings window;                     ///< what no configuration names is as here
  MethodTable table = {};              ///< of methods
};

/// What is compared, in its order. Throws InputError.
std::vector<Configuration> configurations_of(const ComparisonRequest& request);

/// One inspection a configuration, in their order. Throws InputError.
std::vector<std::shared_ptr<const Inspection>> inspect_each(
    const std::shared_ptr<const Recording>& recording, const ComparisonRequest& request);

/// The errors over the length of windows from one start.
struct LengthCurves {
  Figure figure;
  std::vector<std::shared_ptr<const Inspection>> longest;  ///< of the longest window
  std::vector<std::string> failures;  ///< a line for each configuration that solved no window
  bool any_ok = false;
};

/// Throws InputError, also where the recording has no ground truth.
LengthCurves curves_over_length(const std::shared_ptr<const Recording>& recording,
                                const ComparisonRequest& request);

}  // namespace gpo
