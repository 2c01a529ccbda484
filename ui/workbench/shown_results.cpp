// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/shown_results.h"

#include "engine/experiment/configuration.h"
#include "engine/inspection/settings/setting_values.h"
#include "ui/workbench/compared.h"

namespace gpo {

std::vector<ShownResult> shown_results(const WorkbenchState& state) {
  std::vector<ShownResult> shown;
  if (!state.inspection) return shown;
  const Settings& s = state.inspection->settings;
  const auto named = [&](const Settings& settings, bool current) {
    const Configuration one = called_among_compared(state, settings);
    return ShownResult{title_of(one), color_of(one), nullptr, current};
  };
  shown.push_back(named(s, true));
  shown.back().inspection = state.inspection;
  for (const Settings& settings : compared_settings(state, s)) {
    if (as_used(settings) == as_used(s)) continue;
    const Surveyed* surveyed = find_surveyed(state.surveyed.get(), settings);
    if (surveyed == nullptr || !surveyed->inspection) continue;
    shown.push_back(named(settings, false));
    shown.back().inspection = surveyed->inspection;
  }
  return shown;
}

}  // namespace gpo
