// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/eigen_layout.h"
#include "engine/methods/common/initialization.h"
#include "engine/truth/truth.h"

namespace gpo {

/// Returns the number of the window's plane that the truth describes: the leading one, unless the
/// tracks of another plane are within five thresholds of the homographies of the true poses and
/// plane, and three times nearer. nullopt if the true plane is not where most of the leading
/// plane's tracks are in the true reference camera. Tracks that fit no true homography are an error
/// of the result or of the truth, not another plane.
std::optional<int> plane_of_truth(const Window& window, const WindowTruth& truth);

/// Errors of an initialization. Unknown ones are nullopt: ATE, scale, PDE and the path's error in
/// percent if the true path is a point, the aligned PNE also if it is a line; all errors of plane
/// and unaligned path if the true plane or the reference pose is unknown, or if the truth describes
/// another plane than the leading one.
struct Evaluation {
  Alignment alignment = Alignment::ok;   ///< determined by the true camera path
  std::optional<int> plane = 0;          ///< that the truth describes (`plane_of_truth`)
  std::optional<Similarity> T_true_est;  ///< estimate -> truth's world
  std::optional<double> scale;           ///< meters per unit of the estimate
  std::optional<double> ate_m;
  std::optional<double> pne_deg;
  std::optional<double> pne_aligned_deg;
  std::optional<double> pde_m;
  std::optional<double> pne_bound_deg;
  /// Median transfer error of the leading plane's tracks by the true homographies.
  std::optional<double> tracks_px;
  /// PNE over the standard deviation of result and true normal; nullopt without the result's.
  std::optional<double> pne_sigmas;
  /// Scale of the alignment over the scale by the plane's distance: below 1 if the estimated path
  /// is too long beside the plane. The alignment hides such an error from the ATE.
  std::optional<double> scale_ratio;
  /// RMS error of the camera centers in the reference camera's axes, in the scale by the plane's
  /// distance, without alignment; also in percent of the true path's length.
  std::optional<double> path_error_m, path_error_percent;
  /// Errors of the accelerometer's metric scale and gravity; gravity only if the world is upright.
  std::optional<double> scale_error_percent;
  std::optional<double> gravity_error_deg;
};

/// Evaluates an initialization that is `ok` (engine/method.md, "Metrics"). `seed` drives the plane
/// RANSAC, `lens` is the one that the uncertainty assumes.
Evaluation evaluate(const Initialization& initialization,
                    const Window& window,
                    const WindowTruth& truth,
                    std::uint64_t seed,
                    Lens lens = Lens::typical);

/// Returns whether the errors are larger than result and truth together can explain.
bool is_contradiction(const Evaluation& evaluation);

}  // namespace gpo
