// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/methods.h"
#include "engine/results/result_poses.h"
#include "engine/window/window.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Another program's result, as the command line names it (README.md beside this file).
struct ProgramResult {
  std::string name;                      ///< its key and its title as a method
  std::filesystem::path poses;           ///< a trajectory, or a model of COLMAP
  std::filesystem::path points;          ///< in the same world; empty: none
  std::optional<PosedFrame> frame = {};  ///< whose poses; nothing: as the layout has it
};

/// "NAME=FILE[,POINTS][,frame=camera|body]". Throws InputError.
ProgramResult parse_program_result(const std::string& text);

/// Told once what a result says of windows: how many frames, whose poses, whose plane.
using ResultTeller = std::function<void(const std::string& name, const std::string& line)>;

/// The result as a method: of each window the cameras that it has, the others resected; the plane
/// through its points near the window's inlier tracks or, where these are few, through what its
/// cameras triangulate. A window that it does not cover is a failure that says why. Reads the
/// files; throws InputError. `number`: of the user's own methods, for its color.
Method result_method(const ProgramResult& result, const ResultTeller& told, int number);

/// The plane through those of a map's points, 3 x n, that the reference camera sees within 2 deg of
/// an inlier track of its frame, by RANSAC with a fixed seed; in the map's world. The map may hold
/// more than this window and more than one plane. Nothing for fewer than 10 such points.
std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window);

}  // namespace gpo
