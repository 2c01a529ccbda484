// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/surveyed.h"

#include <algorithm>

namespace gpo {

const Surveyed* find_surveyed(const SurveyResults* results, const Settings& settings) {
  if (results == nullptr) return nullptr;
  const auto found = std::ranges::find(*results, settings, &Surveyed::settings);
  return found == results->end() ? nullptr : &*found;
}

}  // namespace gpo
