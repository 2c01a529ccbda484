// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/similarity.h"
#include "engine/methods/common/initialization.h"
#include "engine/truth/truth.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// What is unknown is empty: ATE, scale and PDE where the true path is a point, the aligned PNE
/// also where it is a line; all plane errors where the true plane or the reference pose is unknown.
struct Evaluation {
  Alignment alignment = Alignment::ok;   ///< of the true camera path
  std::optional<Similarity> T_true_est;  ///< estimate -> truth's world
  std::optional<double> scale;           ///< meters per unit of the estimate
  std::optional<double> ate_m;
  std::optional<double> pne_deg;
  std::optional<double> pne_aligned_deg;
  std::optional<double> pde_m;
  std::optional<double> pne_bound_deg;
  /// Of gravity and meters by an accelerometer; gravity where the truth's world stands upright.
  std::optional<double> scale_error_percent;
  std::optional<double> gravity_error_deg;
};

/// Measures an initialization that is `ok`; engine/method.md, "Metrics". `seed` drives the plane
/// RANSAC.
Evaluation evaluate(const Initialization& initialization,
                    const Window& window,
                    const WindowTruth& truth,
                    std::uint64_t seed);

}  // namespace gpo
