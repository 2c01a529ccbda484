// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// A window of one plane may fit two orientations of it equally well.
#include "ui/workbench/state.h"

namespace gpo {

std::vector<Settings> orientation_settings(const WorkbenchState& state) {
  const auto& inspection = state.results.inspection;
  const bool ambiguous = state.document.recording && !state.live && inspection &&
                         inspection->initialization && !inspection->initialization->ok &&
                         inspection->initialization->reason.starts_with(kAmbiguousPlane);
  if (!ambiguous || !(inspection->settings == state.document.settings)) return {};
  std::vector<Settings> both(2, inspection->settings);
  both[0].options.rotations = RotationSource::averaging_first;
  both[1].options.rotations = RotationSource::averaging_second;
  return both;
}

std::vector<Compared> orientation_results(const WorkbenchState& state) {
  std::vector<Compared> results;
  for (const Settings& settings : orientation_settings(state)) {
    Compared one{configuration_of(settings), settings};
    if (const Surveyed* found = find_surveyed(state.results.surveyed.get(), settings)) {
      one.inspection = found->inspection;
      one.error = found->error;
    }
    results.push_back(std::move(one));
  }
  return results;
}

}  // namespace gpo
