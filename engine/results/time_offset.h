// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/results/result_poses.h"

namespace gpo {

/// Difference of two clocks: recording's time = result's time + `seconds`.
struct TimeOffset {
  double seconds = 0;
  double sigma_s = 0;  ///< standard deviation; the noise of neighboring rotations may be correlated
};

/// Returns the pose at a time: rotation on the geodesic and position on the line between the two
/// poses around it. nullopt before the first pose, after the last one, and between poses that are
/// more than `most_ns` apart. `result` has times.
std::optional<Pose> pose_at(const ResultPoses& result, std::int64_t time_ns, std::int64_t most_ns);

/// Estimates the time offset of a result within +-0.5 s: its relative rotations then agree best
/// with those of the reference. `T_posed_camera` transforms the camera to the frame of the poses.
/// nullopt if the result has fewer than four poses a second or fewer than eight rotations in common
/// with the reference, or if the rotations hardly vary, so that sigma exceeds half a period
/// of the poses.
std::optional<TimeOffset> estimate_time_offset(const ResultPoses& result,
                                               const Pose& T_posed_camera,
                                               const ClockReference& reference);

}  // namespace gpo
