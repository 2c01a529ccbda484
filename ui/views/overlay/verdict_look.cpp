// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/verdict_look.h"

#include "ui/context/theme.h"
#include "ui/look/numbers.h"

namespace gpo {

ReadinessLook look_of(Readiness readiness) {
  if (readiness == Readiness::ready) return {Sign::disc, color_of(Role::good)};
  if (readiness == Readiness::weak) return {Sign::triangle, color_of(Role::warning)};
  return {Sign::cross, color_of(Role::bad)};
}

std::string verdict_text(const Verdict& verdict) {
  std::string text = to_string(verdict.readiness);
  if (verdict.normal_sigma_deg) text += ", normal \u00b1" + angle_text(*verdict.normal_sigma_deg);
  if (verdict.rotation_rms_px) {
    text += ", rotation alone leaves " + number_text(*verdict.rotation_rms_px, 2) + " px";
    if (verdict.noise_px) text += " where noise is " + number_text(*verdict.noise_px, 2) + " px";
  }
  if (verdict.largest_translation) {
    text += ", moved " + number_text(*verdict.largest_translation, 3) + " d";
  }
  return text;
}

std::vector<Verdict> shown_growth(const Inspection& inspection) {
  std::vector<Verdict> growth = inspection.growth;
  const auto& result = inspection.initialization;
  const bool whole = static_cast<int>(growth.size()) + 1 == inspection.window->frame_count();
  if (whole && !growth.empty() && result && result->verdict) growth.back() = *result->verdict;
  return growth;
}

std::vector<VerdictRun> verdict_runs(std::span<const Verdict> growth) {
  std::vector<VerdictRun> runs;
  for (int i = 0; i < static_cast<int>(growth.size()); ++i) {
    const Readiness readiness = growth[i].readiness;
    if (runs.empty() || runs.back().readiness != readiness)
      runs.push_back({i + 1, i + 1, readiness});
    runs.back().last = i + 1;
  }
  return runs;
}

}  // namespace gpo
