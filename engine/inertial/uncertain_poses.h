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

/// Poses up to scale, and what is not known of them.
struct UncertainPoses {
  std::vector<Pose> cameras;  ///< one a frame; the first one is the world [plane distance]
  std::vector<std::int64_t> times_ns = {};  ///< of the frames, on the camera's clock
  /// Of the centers of all frames but the first, stacked, then of the gyroscope's bias where that
  /// is known with them (3 more rows).
  Eigen::MatrixXd covariance;
  std::optional<Eigen::Vector3d> bias_rad_s = {};  ///< the gyroscope's, with which they go
  double time_offset_s = 0;                        ///< beyond what the gyroscope says of its clock
  /// Where the rows of `covariance` are in the result's joint one; empty if that is missing.
  std::vector<int> joint_rows = {};

  Eigen::Index center_rows() const { return 3 * (static_cast<Eigen::Index>(cameras.size()) - 1); }
  bool has_bias_covariance() const { return covariance.rows() > center_rows(); }
};

/// The most frames that an alignment takes; more tell hardly more and take the cube of the time.
inline constexpr int kMostAlignedFrames = 60;

/// Of a result that is ok, of every second, third, ... frame where there are too many. Without the
/// joint covariance of its centers the covariance is empty.
UncertainPoses uncertain_poses(const Window& window, const Initialization& result);

}  // namespace gpo
