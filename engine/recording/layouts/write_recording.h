// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/recording/recording.h"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace gpo {

/// What a recording is written as.
enum class RecordingFormat { euroc, rosbag, mcap };
template <>
struct ChoiceKeys<RecordingFormat> {
  static constexpr const char* name = "format";
  static constexpr std::array<const char*, 3> keys = {"euroc", "rosbag", "mcap"};
};

/// Writes a recording that opens as the same recording: as an EuRoC folder (see `write_euroc`), or
/// as a bag, a file with its sidecar files beside it. In a bag are the pictures (of 8 bits, not
/// compressed), /camera_info, /imu by the camera's clock, /ground_truth (of the camera) and
/// /tf_static. Written whole or not at all. Throws InputError: as `write_euroc`, a bag's file that
/// is there already or ends otherwise, sidecar files of something else beside it, no pictures,
/// times before 1970 in a bag of ROS 1.
void write_recording(const Recording& recording,
                     const std::optional<GroundTruth>& truth,
                     RecordingFormat format,
                     const std::filesystem::path& output,
                     const std::function<void(int done, int of)>& progress = {});

/// Writes a recording as an EuRoC folder that opens as the same recording: pictures as PNG (without
/// loss, but of 8 bits), calibration, gyroscope, tracks, board, plane, and `truth` as the poses of
/// the body at the frames' times, not interpolated where a frame has none. Written whole or not at
/// all. Throws InputError: pictures that cannot be decoded, a folder that is not empty, a full
/// disk.
void write_euroc(const Recording& recording,
                 const std::optional<GroundTruth>& truth,
                 const std::filesystem::path& folder,
                 const std::function<void(int done, int of)>& progress = {});

}  // namespace gpo
