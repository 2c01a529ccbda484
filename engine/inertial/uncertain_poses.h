// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Poses up to scale, with their covariance.
struct UncertainPoses {
  std::vector<Pose> cameras;  ///< one a frame; the first one is the world [plane distance]
  std::vector<std::int64_t> times_ns = {};  ///< one a frame, camera clock
  /// Covariance of the centers of all frames but the first, stacked, then of the gyroscope's bias
  /// if it was estimated with them (3 more rows). Empty if unknown.
  Eigen::MatrixXd covariance;
  std::optional<Eigen::Vector3d> bias_rad_s = {};  ///< gyroscope bias of these rotations
  double time_offset_s = 0;                        ///< added to that of the gyroscope's clock
  /// Rows of `covariance` in the result's joint covariance; empty if that is missing.
  std::vector<int> joint_rows = {};

  Eigen::Index center_rows() const { return 3 * (static_cast<Eigen::Index>(cameras.size()) - 1); }
  bool has_bias_covariance() const { return covariance.rows() > center_rows(); }
};

/// Returns the poses of a result that is ok, at most of every second, third, ... frame: more than
/// 60 hardly improve an alignment, whose time grows with their cube.
UncertainPoses uncertain_poses(const Window& window, const Initialization& result);

/// Returns the first `count` poses with their covariance.
UncertainPoses first_poses(const UncertainPoses& poses, int count);

}  // namespace gpo
