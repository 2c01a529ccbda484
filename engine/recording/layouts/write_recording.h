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

enum class RecordingFormat { euroc, rosbag, mcap };
template <>
struct ChoiceKeys<RecordingFormat> {
  static constexpr const char* name = "format";
  static constexpr std::array<const char*, 3> keys = {"euroc", "rosbag", "mcap"};
};

/// Writes a recording that opens as the same recording: as an EuRoC folder (see `write_euroc`), or
/// as a bag with sidecar files beside it. The bag contains the images (8 bits, uncompressed),
/// /camera_info, /imu by the camera's clock, /ground_truth (of the camera) and /tf_static. On
/// failure no partial file remains. Throws InputError for all failures of `write_euroc`, a bag that
/// exists or has the wrong ending, foreign sidecar files beside it, a recording without images, and
/// times before 1970 in a ROS 1 bag.
void write_recording(const Recording& recording,
                     const std::optional<GroundTruth>& truth,
                     RecordingFormat format,
                     const std::filesystem::path& output,
                     const std::function<void(int done, int of)>& progress = {});

/// Writes a recording as an EuRoC folder that opens as the same recording: images as PNG (lossless,
/// but 8 bits), calibration, gyroscope, tracks, board, plane, and `truth` as the body's poses at
/// the frames' times, without interpolation. On failure no partial folder remains. Throws
/// InputError if an image cannot be decoded, the folder is not empty, or the disk is full.
void write_euroc(const Recording& recording,
                 const std::optional<GroundTruth>& truth,
                 const std::filesystem::path& folder,
                 const std::function<void(int done, int of)>& progress = {});

}  // namespace gpo
