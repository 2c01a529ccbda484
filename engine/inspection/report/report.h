// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/recording/bags/messages.h"

#include <nlohmann/json.hpp>

namespace gpo {

struct TimeGap {
  int after = 0;        ///< index of the frame, or line of the sample, before the gap
  double at_s = 0;      ///< its time, from the recording's first frame [s]
  double length_s = 0;  ///< [s]
};

struct GyroscopeInfo {
  double rate_hz = 0;
  bool covers_frames = false;  ///< from the first frame to the last
  std::vector<TimeGap> gaps;   ///< longer than 5 median periods
};

struct TruthInfo {
  std::string source;
  int frames = 0;                                ///< examined frames that have a pose
  int examined = 0;                              ///< a sample of a long recording with a board
  std::optional<PoseUncertainty> uncertainty{};  ///< medians, of a truth from a board
};

struct TracksInfo {
  int tracks = 0;
  int observations = 0;
  int longest = 0;  ///< observations of one track
};

/// Contents of a recording, as `info` prints them.
struct RecordingInfo {
  const Recording* recording = nullptr;  ///< must outlive this
  double duration_s = 0;
  double rate_hz = 0;         ///< 1 / median period; 0 for a single frame
  std::vector<TimeGap> gaps;  ///< longer than 1.5 median periods
  std::optional<GyroscopeInfo> gyroscope;
  std::optional<TruthInfo> truth;
  std::optional<TracksInfo> tracks;
  std::vector<std::string> notes;
  std::vector<Finding> findings;  ///< findings of the checks that need no window
  std::vector<FoundFile> files;   ///< see `found_files`
};

/// Returns what was found in a recording's folder, read or not and why, with paths relative to it.
/// For a single file only what readers report.
std::vector<FoundFile> found_files(const Recording& recording);
std::string to_text(const FoundFile& one);

/// Describes a recording. Searches for the board in every frame (in a regular sample of more than
/// 300), which takes about 20 ms a frame and processor, once. Throws InputError for images that
/// cannot be decoded.
RecordingInfo describe(const Recording& recording);

nlohmann::json to_json(const RecordingInfo& info);
/// Returns a table for people, each line ended.
std::string to_text(const RecordingInfo& info);

/// A topic of a bag and its role, as `info` lists them.
struct TopicInfo {
  BagTopic topic;
  std::optional<TopicRole> role;
};

/// Returns the topics of a bag, without roles if it has no camera; empty if it cannot be read.
std::vector<TopicInfo> describe_topics(const fs::path& path, const TopicChoices& choices);

nlohmann::json to_json(const std::vector<TopicInfo>& topics);
/// Returns rows of the table of a recording, each line ended.
std::string to_text(const std::vector<TopicInfo>& topics);

/// `run --json`. World = reference camera, gauge d = 1; quaternions x y z w; null: unknown.
nlohmann::ordered_json to_json(const Inspection& inspection);

/// Returns the settings as they were used, with defaults replaced by their values.
Settings settings_used(const Inspection& inspection);

/// Returns the quaternion of a rotation, w last and not negative.
Eigen::Vector4d quaternion_xyzw(const Eigen::Matrix3d& R);

/// Adds `imported`, `metric_scale` and `world` to a result if they are known or requested.
void add_world(const Inspection& inspection, nlohmann::ordered_json& json);

/// Returns a setting's value; null if it is left to the method.
nlohmann::ordered_json value_json(const SettingValue& value);

nlohmann::ordered_json pose_uncertainty_json(const PoseUncertainty& uncertainty);

/// Returns a list of findings with all their fields.
nlohmann::ordered_json to_json(std::span<const Finding> findings);

/// Returns the short table that `run` prints, with units.
std::string to_text(const Inspection& inspection);

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
struct ChoiceKeys<TrajectoryFormat> : NamedKeys<"trajectory format", "tum", "euroc", "kitti"> {};

struct Extrapolation;
/// Returns the value of `extrapolated` in the JSON of a result.
nlohmann::ordered_json to_json(const Extrapolation& after);

/// Returns the estimated poses. Throws InputError if the initialization failed.
CameraPath estimated_path(const Inspection& inspection, const ExportWorld& world = {});

/// Returns the known true poses of the window [m]. Throws InputError without ground truth.
CameraPath true_path(const Inspection& inspection);

/// Returns the text of a trajectory file. Throws InputError for an incomplete trajectory in KITTI's
/// format, which cannot mark missing frames.
std::string to_text(const CameraPath& trajectory, TrajectoryFormat format);

}  // namespace gpo
