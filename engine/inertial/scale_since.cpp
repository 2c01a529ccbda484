// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/scale_since.h"

#include <numeric>

namespace gpo {

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

std::optional<int> poses_that_constrain_scale(const UncertainPoses& poses,
                                         const Gyroscope& gyroscope,
                                         const std::optional<Pose>& T_body_camera,
                                         const InertialOptions& options) {
  const auto tell = [&](int count) {
    const auto aligned =
        align_inertial(first_poses(poses, count), gyroscope, T_body_camera, options);
    return aligned.ok && aligned.scale_known;
  };
  int too_few = 1, enough = static_cast<int>(poses.cameras.size());
  if (!tell(enough)) return std::nullopt;
  while (enough - too_few > 1) {
    const int between = (too_few + enough) / 2;
    (tell(between) ? enough : too_few) = between;
  }
  return enough;
}

}  // namespace gpo
