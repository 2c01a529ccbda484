// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/methods/common/method_options.h"
#include "engine/methods/joint/joint_model.h"

#include <limits>
#include <optional>

namespace gpo::joint {

struct Solution {
  PlaneMotion motion;
  SolverReport solver;  ///< cost: the robust loss with the priors
  Scales scales;
  double row_delay_s = 0;
  std::optional<LensResidual> lens_residual = std::nullopt;  ///< nullopt: none is likely
  Uncertainty uncertainty;
  std::optional<PlaneMotion> other = std::nullopt;  ///< the other minimum, if there is one
};

/// Another solution of the same window.
struct Rival {
  double cost = std::numeric_limits<double>::infinity();
  double most_ratio = 1;  ///< a cost that is higher than the rival's by this factor does not count
};

/// Minimizes the joint cost from a solution of the transfer error, with all observations of the
/// tracks of the window's planes. nullopt if it is not determined, a point is behind a camera,
/// `watch` stopped it, or its cost will not count beside the rival's. A solution that costs more
/// than the rival has no uncertainty.
std::optional<Solution> solve(const Window& window,
                              const PlaneMotion& start,
                              const Options& options,
                              const Watch& watch,
                              const Rival& rival = {});

/// Returns the better one of two solutions of a window whose cost has two minima, with the other
/// one in `other`. If the other one fits as well and is close, the cost between them is flat, and
/// half of the way to it is added to the uncertainty.
Solution better_of_twins(Solution one, Solution other);

}  // namespace gpo::joint
