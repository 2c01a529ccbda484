// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/inspection/inspection.h"

#include <nlohmann/json.hpp>

namespace gpo {

/// Returns the result of `run --json`. World = reference camera, gauge d = 1; quaternions x y z w.
/// Plane and poses are null for a failed initialization, metrics are null if unknown.
/// `unused_settings` has the keys of settings without effect on this method or recording.
nlohmann::ordered_json to_json(const Inspection& inspection);

/// Returns the settings as they were used, with defaults replaced by their values.
Settings settings_used(const Inspection& inspection);

/// Returns a setting's value; null if it is left to the method.
nlohmann::ordered_json value_json(const SettingValue& value);

nlohmann::ordered_json pose_uncertainty_json(const PoseUncertainty& uncertainty);

/// Returns the short table that `run` prints, with units.
std::string to_text(const Inspection& inspection);

/// Returns the map points as ASCII PLY with their track's id, as the views draw them. Unit:
/// distance of the plane, or meter.
std::string to_ply(const Inspection& inspection, const std::optional<double>& meters_per_unit = {});

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
