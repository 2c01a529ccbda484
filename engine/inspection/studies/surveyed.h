// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <memory>
#include <string>
#include <vector>

namespace gpo {

/// One of many settings, and what came of it.
struct Surveyed {
  Settings settings;
  std::shared_ptr<const Inspection> inspection;  ///< null: it could not be computed
  std::string error;                             ///< why not, one line
};

/// Immutable; what was computed later stands later.
using SurveyResults = std::vector<Surveyed>;

/// Null where these settings are not among them.
const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings);

}  // namespace gpo
