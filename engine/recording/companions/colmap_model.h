// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/geometry/pose.h"

#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// Limit for coordinates of a plausible result.
inline constexpr double kMaxCoordinate = 1e12;

/// Camera poses by the names of images.
struct NamedPoses {
  std::vector<std::string> names;  ///< "cam0/1.png"
  std::vector<Pose> poses;         ///< world from camera, one for each name
};

/// Reads images.txt, or images.bin if `file` ends with .bin. Throws InputError.
NamedPoses read_colmap_poses(const fs::path& file, std::string_view bytes);

/// Reads the positions (3 x n) in points3D.txt or points3D.bin. Throws InputError likewise.
Eigen::Matrix3Xd read_colmap_points(const fs::path& file, std::string_view bytes);

}  // namespace gpo
