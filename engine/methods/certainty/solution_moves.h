// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// What moves a solution beside the noise of its observations: the gyroscope's noise, the lens.
#pragma once

#include "engine/methods/certainty/sandwich.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"
#include "engine/window/window.h"

#include <cstddef>
#include <vector>

namespace gpo {

/// Of each step of a gyroscope's walk about each of the world's axes; none where it is not unknown.
std::vector<SolutionMove> moves_by_gyro_noise(const Window& window,
                                              const PlaneMotion& motion,
                                              const Bread& bread,
                                              const SharedMatrix& shared_inverse);

/// One standard deviation of a parameter of the lens.
SolutionMove move_by_lens(const Window& window,
                          const PlaneObservations& observations,
                          const PlaneMotion& motion,
                          const Bread& bread,
                          const SharedMatrix& shared_inverse,
                          std::size_t parameter);

/// Adds what a gyroscope's noise, a random walk, moves where it is unknown (engine/method.md, eq.
/// 14f).
void add_gyro_noise(const Window& window,
                    const PlaneMotion& motion,
                    const Bread& bread,
                    const SharedMatrix& shared_inverse,
                    Spread& spread);

/// Adds what is not known of the lens: its parameters' errors are independent, each moves the whole
/// solution.
void add_lens(const Window& window,
              const PlaneObservations& observations,
              const PlaneMotion& motion,
              const Bread& bread,
              const SharedMatrix& shared_inverse,
              Spread& spread);

}  // namespace gpo
