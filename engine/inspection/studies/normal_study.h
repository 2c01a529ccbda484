// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/normal_landscape.h"
#include "engine/window/window.h"

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

namespace gpo {

/// Evidence of a window on the plane's normal, independent of the method. Immutable.
struct NormalStudy {
  std::shared_ptr<const Window> window;
  NormalLandscape landscape;
  std::vector<std::vector<HomographyCandidate>> candidates;  ///< one a frame of the window
  std::vector<NormalCluster> clusters;                       ///< over the whole window's candidates
  std::string error = {};  ///< why it failed, one line; then only `window` is set
};

/// Returns the study; null if stopped. Throws InputError for bad input.
std::shared_ptr<const NormalStudy> study_normals(const Inspection& inspection,
                                                 const std::stop_token& stop = {});

/// Returns the true normal in the reference camera, towards it; nullopt if unknown.
std::optional<Eigen::Vector3d> true_normal(const Inspection& inspection);

}  // namespace gpo
