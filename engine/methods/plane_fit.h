// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/method_options.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_solver.h"
#include "engine/window/window.h"

namespace gpo {

/// Rounds of reweighting, each started from the previous solution. All but the last take one step.
struct Rounds {
  int count = 10;
  bool start_is_weighted = false;  ///< else it is optimized without weights first
};

/// Which part of the rotations is unknown.
struct RotationUnknowns {
  RotationModel model = RotationModel::known;
  bool gyro_noise = false;
};

/// A solution, and the window corrected for its row delay.
struct Fit {
  Window window;
  PlaneSolution solution;
  RotationUnknowns rotations;
  double row_delay_s = 0;
  double cost = 0;  ///< robust loss, comparable between different weights [px^2]
  PlaneObservations observations = {};  ///< from `window`, with the weights of the last round
};

/// A window and how its planes are fitted.
struct FitTask {
  const Window& window;
  const MethodOptions& options;
  double sigma_px;  ///< noise of a coordinate
  const Watch& watch;

  /// automatic: for tracks with noise in the reference frame, and for a rolling shutter.
  bool latent(double row_delay_s = 0) const {
    if (options.error != ErrorModel::automatic) return options.error == ErrorModel::latent;
    const bool known = options.shutter == Shutter::known && window.row_delay;
    return !window.exact_reference || row_delay_s != 0 || (known && window.row_delay->mean_s != 0);
  }
};

/// Significance of additional unknowns: chi-square test at 4 sigma.
inline constexpr double kSignificantSigmas = 4;

/// Returns the iteratively reweighted least-squares solution over the planes of `start`, with the
/// points as they are, without any checks.
Fit fit_planes(const FitTask& task,
               const PlaneMotion& start,
               RotationUnknowns rotations,
               const Rounds& rounds = {});

/// Returns the fit with the row delay that explains the points significantly better, estimated by
/// iterated parabola fits through the costs at three values; `given` if there is none, the shutter
/// is global or the joint model estimates it.
Fit with_estimated_shutter(const FitTask& task, const Fit& given);

/// Adds the time and iterations of another solution.
void add_effort(const SolverReport& tried, SolverReport& solver);
/// Copies the weights of the same observations at other points.
void copy_weights(const PlaneObservations& from, PlaneObservations& to);

bool converged(const Fit& fit);
int freedom(const Fit& fit);
/// Returns the noise variance of one coordinate, estimated from the residuals [px^2].
double variance(const Fit& fit);
/// Returns true if additional unknowns explain more than noise, whose variance is taken from
/// `with`.
bool is_significant(const Fit& without, const Fit& with, int more_unknowns);

}  // namespace gpo
