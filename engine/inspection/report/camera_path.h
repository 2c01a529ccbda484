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
  std::vector<Pose> cameras;  ///< as many
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

/// World = reference camera, unit = distance of the plane, or the meter. Throws InputError for an
/// initialization that failed.
CameraPath estimated_path(const Inspection& inspection,
                          const std::optional<double>& meters_a_unit = {});

/// The true poses of the same window, of the frames that have one [m]. Throws InputError where no
/// truth is known.
CameraPath true_path(const Inspection& inspection);

/// Throws InputError for an incomplete trajectory in KITTI's format, which cannot say which frames
/// are missing.
std::string to_text(const CameraPath& trajectory, TrajectoryFormat format);

}  // namespace gpo
