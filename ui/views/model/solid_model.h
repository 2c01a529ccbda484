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

/// Corners in the order of `cube_corners`.
using CubeCorners = std::array<Eigen::Vector3d, 8>;

/// A triangle mesh in the cube's place. Its frame is right-handed: z is up, y away from the viewer,
/// the origin at the middle of its foot; its longer horizontal side is 1 side of the cube.
struct SolidModel {
  std::vector<Eigen::Vector3d> points;            ///< [sides of the cube]
  std::vector<std::array<int, 3>> triangles;      ///< indices of points
  std::vector<std::optional<std::uint32_t>> rgb;  ///< by triangle; nullopt: the cube's color
  std::vector<double> light;                      ///< by triangle, 0 (none) to 1
  double height_sides = 1;
};

/// Reads "robot", which is embedded in the program, or a file: .obj, .gltf, .glb (y is up), .ply (z
/// is up, colors by vertex). Throws InputError with the file's name.
SolidModel read_solid_model(const std::string& name);

/// Returns the model's points in place of a cube (`cube_corners`, of one side's height).
std::vector<Eigen::Vector3d> placed_on(const SolidModel& model, const CubeCorners& cube_corners_w);

/// Returns the share of the light that reaches a point: the ground blocks some, `at_foot` is left.
double light_above_ground(double height_sides, double at_foot = 0.6);

/// Returns a triangle's color in its light, multiplied by `above_ground`.
std::uint32_t lit_rgb(const SolidModel& model,
                      std::size_t triangle,
                      std::uint32_t cube_rgb,
                      double above_ground = 1);

}  // namespace gpo
