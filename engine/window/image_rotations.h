// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Rotations that the pictures of one window tell.
struct ImageRotations {
  std::vector<std::int64_t> timestamps_ns;  ///< camera clock, ascending, two at least
  std::vector<Eigen::Matrix3d> R_wc;        ///< one a frame, I of the first
};

}  // namespace gpo
