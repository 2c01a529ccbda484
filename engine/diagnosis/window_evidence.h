// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <optional>
#include <span>

namespace gpo {

/// Residuals that a verdict depends on, accumulated frame by frame.
class WindowEvidence {
 public:
  void add(const FrameErrors& errors);
  /// Returns the standard deviation of a coordinate from the homographies' residuals [px].
  double noise_px() const;
  /// Returns the same from the residuals of the best rotation of each frame [px].
  double rotation_rms_px() const;

 private:
  int frames_ = 0;
  double residuals_ = 0;
  double homography_squares_ = 0;
  double rotation_squares_ = 0;
};

WindowEvidence evidence_of(const Window& window);

/// Returns the numbers of a verdict that `verdict_of` judges (engine/diagnosis).
Verdict numbers_of(const WindowEvidence& evidence,
                   std::optional<double> normal_sigma_deg,
                   double largest_translation);

/// Returns the same for a result that is ok, with the scene; the uncertainty is the result's.
Verdict window_numbers(const Window& window, const Initialization& result, Lens lens);

/// Returns F with p_i^T F p_0 = 0 for pixels of the reference camera and of `camera`, up to scale.
Eigen::Matrix3d fundamental_matrix(const Eigen::Matrix3d& K_inverse, const Pose& camera);

/// Returns the first-order distance of a pair from the epipolar geometry p_i^T F p_0 = 0 [px].
double sampson_px(const Eigen::Matrix3d& F, const Eigen::Vector2d& p_0, const Eigen::Vector2d& p_i);

/// Returns the kind of scene; unknown if inliers are not chosen by planes.
SceneKind scene_of(const Window& window);

/// Compares planes with free points over all tracks (engine/method.md, "The verdict on a window").
/// `noise_px` of a coordinate. nullopt without planes or with fewer than eight tracks.
std::optional<SceneCriterion> scene_criterion(const Window& window,
                                              std::span<const Pose> cameras,
                                              double noise_px);

}  // namespace gpo
