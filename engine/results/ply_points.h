// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include <Eigen/Core>

namespace gpo {

/// The vertices' x, y and z of a PLY file, ascii or binary little-endian, 3 x n; faces and other
/// properties are passed over. Throws InputError that names the line, or the vertex.
Eigen::Matrix3Xd read_ply_points(const std::filesystem::path& file, std::string_view bytes);

/// Beyond this, coordinates are no result.
inline constexpr double kLargestCoordinate = 1e12;

}  // namespace gpo
