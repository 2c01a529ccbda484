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

/// Another program's result as named on the command line (see README.md).
struct ProgramResult {
  std::string name;                      ///< key and title of the method
  std::filesystem::path poses;           ///< a trajectory or a COLMAP model
  std::filesystem::path points;          ///< in the same world; empty: none
  std::optional<PosedFrame> frame = {};  ///< nullopt: the default of the layout
};

/// Parses "NAME=FILE[,POINTS][,frame=camera|body]". Throws InputError.
ProgramResult parse_program_result(const std::string& text);

/// Receives each distinct message about a result's frames, poses and plane once.
using ResultLog = std::function<void(const std::string& name, const std::string& line)>;

/// Returns the result as a method. For each window it has the result's cameras, with missing ones
/// resected, and the plane through the result's points near the window's inlier tracks or, if these
/// are few, through points triangulated from its cameras. Windows that the result does not cover
/// fail with a reason. Reads the files; throws InputError. `number`: among the user's methods.
Method result_method(const ProgramResult& result, const ResultLog& log, int number);

/// Returns the plane, in the map's world, through the map's points (3 x n) that the reference
/// camera sees within 2 deg of an inlier track, by RANSAC with a fixed seed; nullopt for fewer than
/// 10 such points. The map may be larger than the window and have other planes.
std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window);

}  // namespace gpo
