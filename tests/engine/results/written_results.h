// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo::test {

// Results in the formats of other programs. Poses: world from camera or body.

/// Returns "seconds p q_xyzw" or, with `ns`, ORB-SLAM3's "1520530308199447552.000000 ..." for
/// EuRoC.
std::string tum_text(const std::vector<std::int64_t>& times_ns,
                     const std::vector<Pose>& poses,
                     bool ns = false);
/// Returns VINS-Mono's "ns,p,q_wxyz,v," without a header.
std::string vins_text(const std::vector<std::int64_t>& times_ns, const std::vector<Pose>& poses);
std::string kitti_text(const std::vector<Pose>& poses);

std::string colmap_images_text(const std::vector<std::string>& names,
                               const std::vector<Pose>& cameras);
std::string colmap_images_binary(const std::vector<std::string>& names,
                                 const std::vector<Pose>& cameras);
std::string colmap_points_text(const Eigen::Matrix3Xd& points);
std::string colmap_points_binary(const Eigen::Matrix3Xd& points);
/// Returns vertices with colors, and a face at the end.
std::string ply_text(const Eigen::Matrix3Xd& points);
std::string ply_binary(const Eigen::Matrix3Xd& points);

/// Returns the bytes of a number, little-endian.
template <class T>
std::string bytes_of(T value) {
  return {reinterpret_cast<const char*>(&value), sizeof(T)};
}

}  // namespace gpo::test
