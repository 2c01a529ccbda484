// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Body poses over time, as EuRoC stores them.
struct BodyPath {
  std::vector<std::int64_t> timestamps_ns;  ///< strictly ascending
  std::vector<Pose> T_world_body;
  std::int64_t median_period_ns = 0;
  std::optional<Eigen::Vector3d> mean_gyro_bias_rad_s;  ///< where the file has the columns
};

/// state_groundtruth_estimate0/data.csv or mocap0/data.csv: time stamp, p, q_wxyz, and in EuRoC's
/// own files v, b_w, b_a. Throws InputError.
BodyPath read_body_path(const std::filesystem::path& file);

/// The pose at a time, slerp and linear between the two samples around it; nothing where these are
/// more than three (median) sample periods apart, or the time is outside of the path.
std::optional<Pose> pose_at(const BodyPath& path, std::int64_t time_ns);

}  // namespace gpo
