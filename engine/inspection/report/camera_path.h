// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/inspection/inspection.h"

#include <array>
#include <optional>
#include <string>

namespace gpo {

/// Camera poses over time.
struct CameraPath {
  std::vector<std::int64_t> timestamps_ns;
  std::vector<Pose> cameras;  ///< one per time stamp
  std::string world;          ///< axes and unit, for people
  bool complete = true;       ///< every frame of the window has a pose
};

/// tum: seconds, p, q_xyzw; euroc: nanoseconds, p, q_wxyz with commas; kitti: the 12 numbers of
/// (R | p) row by row, without times. evo reads all of them.
enum class TrajectoryFormat { tum, euroc, kitti };

template <>
struct ChoiceKeys<TrajectoryFormat> {
  static constexpr const char* name = "trajectory format";
  static constexpr std::array keys{"tum", "euroc", "kitti"};
};

/// Returns the estimated poses. World = reference camera, unit = distance of the plane, or meter.
/// Throws InputError if the initialization failed.
CameraPath estimated_path(const Inspection& inspection,
                          const std::optional<double>& meters_per_unit = {});

/// Returns the known true poses of the window [m]. Throws InputError without ground truth.
CameraPath true_path(const Inspection& inspection);

/// Returns the text of a trajectory file. Throws InputError for an incomplete trajectory in KITTI's
/// format, which cannot mark missing frames.
std::string to_text(const CameraPath& trajectory, TrajectoryFormat format);

}  // namespace gpo
