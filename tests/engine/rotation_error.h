// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

namespace gpo::test {

inline double rotation_error_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return degrees(so3_log(a.transpose() * b).norm());
}
inline double rotation_error_deg(const Pose& a, const Pose& b) {
  return rotation_error_deg(a.R_wc, b.R_wc);
}

}  // namespace gpo::test
