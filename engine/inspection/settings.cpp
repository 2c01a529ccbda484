// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings.h"

#include "engine/initializers/methods.h"

namespace gpo {

bool uses_ransac(const Settings& settings) {
  return settings.ransac.value_or(find_method(settings.method).needs_plane);
}

Inliers inliers_used(const Settings& settings) {
  return settings.inliers.value_or(find_method(settings.method).inliers);
}

}  // namespace gpo
