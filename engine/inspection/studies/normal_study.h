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

/// What a window says about the plane's normal, whatever a method makes of it. Immutable.
struct NormalStudy {
  std::shared_ptr<const Window> window;
  NormalLandscape landscape;
  std::vector<std::vector<HomographyCandidate>> candidates;  ///< one a frame of the window
  std::vector<NormalCluster> clusters;                       ///< of the whole window's candidates
  std::string error = {};  ///< why it could not be made, one line: then it has `window` alone
};

/// Null where it was stopped. Throws what the engine throws.
std::shared_ptr<const NormalStudy> study_normals(const Inspection& inspection,
                                                 const std::stop_token& stop = {});

/// The true normal in the reference camera, towards it; nothing where it is unknown.
std::optional<Eigen::Vector3d> true_normal(const Inspection& inspection);

}  // namespace gpo
