// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"

#include "engine/pipeline/method_defaults.h"

namespace gpo {

std::string inliers_note(const Inspection& inspection) {
  if (inspection.window->inliers == Inliers::consistent) return "tracks, consistent";
  const Settings& settings = inspection.settings;
  const bool asked =
      uses_ransac(settings.options) && inliers_used(settings.options) == Inliers::consistent;
  return asked ? "tracks, per frame: too few are consistent" : "tracks";
}

}  // namespace gpo
