// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initializers/methods.h"
#include "engine/results/result_poses.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

}  // namespace gpo
