// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/common/watch.h"
#include "engine/methods/plane/plane_solver.h"
#include "engine/window/window.h"

namespace gpo {

/// The minimum of `initialize_gpo`, not yet judged: the sign is arbitrary.
PlaneSolution solve_gpo(const Window& window, const MethodOptions& options, const Watch& watch);

/// Global plane optimization (Du et al. 2020): minimizes over the plane's normal and the scaled
/// translations of all frames the summed squared transfer error of the inliers, the window's
/// rotations held fixed; 3m - 1 unknowns. No homography is decomposed, no point triangulated.
/// Ceres starts from rest as in the paper, our own solver from the closed form.
Initialization initialize_gpo(const Window& window,
                              const MethodOptions& options,
                              const Watch& watch);

}  // namespace gpo
