// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/shown_results.h"

#include "engine/experiment/configuration.h"

namespace gpo {

std::vector<ShownResult> shown_results(const WorkbenchState& state) {
  std::vector<ShownResult> shown;
  if (!state.inspection) return shown;
  const Settings& s = state.inspection->settings;
  const Configuration own{s.method, s.ransac, s.rotations, s.tracking, s.inliers};
  shown.push_back({title_of(own), color_of(own), state.inspection, true});
  for (const std::string& key : state.compared) {
    const Configuration configuration = parse_configuration(key);
    const Settings settings = apply(configuration, s);
    const std::string title = title_of(configuration);
    const std::uint32_t rgb = color_of(configuration);
    if (settings == s) {
      shown.front().name = title;
      shown.front().rgb = rgb;
      continue;
    }
    const Surveyed* surveyed = find_surveyed(state.surveyed.get(), settings);
    if (surveyed != nullptr && surveyed->inspection)
      shown.push_back({title, rgb, surveyed->inspection, false});
  }
  return shown;
}

}  // namespace gpo
