// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/pose.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Beyond this, coordinates are no result.
inline constexpr double kLargestCoordinate = 1e12;

/// A picture that COLMAP has found a place for.
struct ColmapImage {
  std::string name;  ///< below the folder of the pictures, "cam0/1.png"
  Pose camera;       ///< camera to world, the inverse of what the file has
};

/// What is in an images.txt or, by the ending of `file`, an images.bin. Throws InputError that
/// names the line, or the image and the byte.
std::vector<ColmapImage> read_colmap_images(const std::filesystem::path& file,
                                            std::string_view bytes);

/// What is in a points3D.txt or points3D.bin: positions, 3 x n. Throws InputError likewise.
Eigen::Matrix3Xd read_colmap_points(const std::filesystem::path& file, std::string_view bytes);

}  // namespace gpo
