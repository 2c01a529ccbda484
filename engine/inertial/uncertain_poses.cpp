// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/uncertain_poses.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace gpo {

UncertainPoses uncertain_poses(const Window& window, const Initialization& result) {
  constexpr int kMostFrames = 60;
  const int all = window.frame_count();
  const int step = (all - 1 + kMostFrames - 1) / kMostFrames;
  UncertainPoses poses;
  std::vector<int> rows;  // chosen rows of the covariance of all centers
  for (int i = 0; i < all; i += std::max(1, step)) {
    poses.cameras.push_back(result.cameras[i]);
    poses.times_ns.push_back(window.timestamps_ns[i]);
    for (int axis = 0; i > 0 && axis < 3; ++axis) rows.push_back(3 * (i - 1) + axis);
  }
  poses.bias_rad_s = result.bias_rad_s;
  if (!poses.bias_rad_s && window.gyro) poses.bias_rad_s = window.gyro->bias_rad_s;
  poses.time_offset_s = result.time_offset_s.value_or(0);
  if (!result.uncertainty || result.uncertainty->joint_covariance.size() == 0) return poses;
  const Uncertainty& u = *result.uncertainty;
  for (int k = 0; k < u.joint_bias_rows; ++k) rows.push_back(3 * (all - 1) + k);
  poses.covariance = u.joint_covariance(rows, rows);
  poses.joint_rows = std::move(rows);
  return poses;
}

UncertainPoses first_poses(const UncertainPoses& poses, int count) {
  UncertainPoses first = poses;
  first.cameras.resize(count);
  first.times_ns.resize(count);
  std::vector<Eigen::Index> rows(first.center_rows());
  std::iota(rows.begin(), rows.end(), 0);
  for (Eigen::Index k = poses.center_rows(); k < poses.covariance.rows(); ++k) rows.push_back(k);
  first.covariance = poses.covariance(rows, rows);
  return first;
}

}  // namespace gpo
