// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/joint/joint_model.h"

namespace gpo::joint {

/// Returns the uncertainty of a solution: the cluster-robust covariance with tracks as clusters, at
/// least that of independent noise, widened if the errors of neighboring tracks agree, plus the
/// contribution of the priors (engine/method.md, eq. 29). `at` has the curvature of the loss.
Uncertainty uncertainty_of(const Model& model,
                           const State& state,
                           const Normals& at,
                           const Scales& scales);

}  // namespace gpo::joint
