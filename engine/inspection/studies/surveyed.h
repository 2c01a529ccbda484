// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace gpo {

/// Result for one of many settings.
struct Surveyed {
  Settings settings;
  std::shared_ptr<const Inspection> inspection;  ///< null if it failed
  std::string error;                             ///< why it failed, one line
};

/// Results in the order of their computation. Immutable.
using SurveyResults = std::vector<Surveyed>;

/// Returns the result for the settings; null if there is none.
inline const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings) {
  if (results == nullptr) return nullptr;
  const auto found = std::ranges::find(*results, settings, &Surveyed::settings);
  return found == results->end() ? nullptr : &*found;
}

}  // namespace gpo
