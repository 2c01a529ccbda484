// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A body of triangles that stands in the cube's place. Its frame is right-handed, z is up, y away
/// from who looks at it; the middle of its foot is the origin, its longer horizontal side 1 side of
/// the cube.
struct SolidModel {
  std::vector<Eigen::Vector3d> points;            ///< [sides of the cube]
  std::vector<std::array<int, 3>> triangles;      ///< indices of points
  std::vector<std::optional<std::uint32_t>> rgb;  ///< by triangle; nothing: the cube's
  std::vector<double> light;                      ///< by triangle, 0 (none) to 1
  double height_sides = 1;
};

/// "robot", which the program carries with it, or a file: .obj, .gltf, .glb (y is up), .ply (z is
/// up, colors by vertex). Throws InputError that names the file.
SolidModel read_solid_model(const std::string& name);

/// Its points where the cube of these corners (`cube_corners`, of one side's height) stands.
std::vector<Eigen::Vector3d> placed_on(const SolidModel& model,
                                       const std::array<Eigen::Vector3d, 8>& cube_corners_w);

/// How much of the light reaches a point at this height: the ground keeps some off its foot.
double light_above_ground(double height_sides);

/// A triangle's color in its light, of which so much reaches it.
std::uint32_t lit_rgb(const SolidModel& model,
                      std::size_t triangle,
                      std::uint32_t cube_rgb,
                      double above_ground = 1);

}  // namespace gpo
