// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/csv_table.h"
#include "engine/geometry/pose.h"
#include "engine/recording/recording.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Poses over time of the frame that a truth file measures: the body, a camera or markers.
struct PosePath {
  std::vector<std::int64_t> timestamps_ns;              ///< strictly ascending
  std::vector<Pose> poses;                              ///< in the truth's world [m]
  std::int64_t longest_gap_ns = 0;                      ///< largest gap to interpolate
  std::optional<Eigen::Vector3d> mean_gyro_bias_rad_s;  ///< if the file has the columns
};

/// Reads EuRoC's data.csv of state_groundtruth_estimate0, mocap0 or vicon0: time stamp, p, q_wxyz,
/// and in EuRoC's own files v, b_w, b_a. Throws InputError.
PosePath read_euroc_path(const std::filesystem::path& file);

/// Reads TUM's groundtruth.txt: seconds (or `unit`), p, q_xyzw, separated by blanks. Throws
/// InputError.
PosePath read_tum_path(const std::filesystem::path& file, TimeUnit unit = TimeUnit::seconds);

/// Interpolates the pose at a time (slerp and linear); nullopt outside of the path and in gaps that
/// are too long.
std::optional<Pose> pose_at(const PosePath& path, std::int64_t time_ns);

/// Transform to the measured frame and clock offset.
struct TruthMounting {
  Pose T_measured_camera;           ///< hand-eye: x_measured = R x_camera + p
  std::int64_t time_offset_ns = 0;  ///< truth's clock = camera's clock + offset
};

/// Three median periods, the default of the longest gap to interpolate.
std::int64_t usual_longest_gap_ns(const std::vector<std::int64_t>& timestamps_ns);

/// Returns camera poses at the frames' times. `source` is for people.
GroundTruth camera_truth(const PosePath& path,
                         const TruthMounting& mounting,
                         std::string source,
                         const std::vector<std::int64_t>& frame_times_ns);

/// Reads the optional keys `time_offset_s` and `longest_gap_s` of the YAML file beside a truth
/// file. Throws InputError.
void read_truth_clock(const std::filesystem::path& yaml, PosePath& path, TruthMounting& mounting);

/// Reads the same keys and the hand-eye calibration `T_truth_camera` of the optional
/// groundtruth.yaml in a folder. Throws InputError.
void read_mounting_beside(const std::filesystem::path& folder,
                          PosePath& path,
                          TruthMounting& mounting);

/// Reads the groundtruth.txt and groundtruth.yaml beside a recording; nullopt without
/// groundtruth.txt. Throws InputError.
std::optional<GroundTruth> truth_beside(const std::filesystem::path& folder,
                                        const std::vector<std::int64_t>& frame_times_ns);

}  // namespace gpo
