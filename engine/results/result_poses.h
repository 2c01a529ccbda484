// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/pose.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Whose poses a file has: the camera's, or the body's (the axes of the IMU).
enum class PosedFrame { camera, body };

template <>
struct ChoiceKeys<PosedFrame> {
  static constexpr const char* name = "frame";
  static constexpr std::array keys{"camera", "body"};
};

/// How a file's poses find their frames of a recording.
enum class FoundBy { time, number, name };

/// Poses that another program found, in its own world and scale.
struct ResultPoses {
  std::string layout;                       ///< for people: "COLMAP"
  PosedFrame frame = PosedFrame::camera;    ///< by the layout, unless the user says otherwise
  FoundBy by = FoundBy::time;               ///< by number: pose 0 is of the recording's frame 0
  std::vector<std::int64_t> timestamps_ns;  ///< by time: one a pose, strictly ascending
  std::vector<std::string> names;           ///< by name: one a pose, of its picture, with '/'
  std::vector<Pose> poses;                  ///< world from camera, or from body
};

/// Reads a trajectory: TUM's, also as ORB-SLAM3 writes it with nanoseconds (8 numbers with blanks),
/// EuRoC's, also VINS-Mono's (8 or more with commas), KITTI's (12 with blanks); or COLMAP's poses,
/// an images.txt, an images.bin or the folder of a model. Throws InputError.
ResultPoses read_result_poses(const std::filesystem::path& path);

/// Whether a folder, a model of COLMAP, has points.
bool has_points(const std::filesystem::path& folder);

/// Reads points, 3 x n, in the world of the poses: PLY, or COLMAP's points3D.txt, points3D.bin or
/// the folder of a model. Throws InputError.
Eigen::Matrix3Xd read_result_points(const std::filesystem::path& path);

/// The vertices' x, y and z of a PLY file, ascii or binary little-endian, 3 x n; faces and other
/// properties are passed over. Throws InputError that names the line, or the vertex.
Eigen::Matrix3Xd read_ply_points(const std::filesystem::path& file, std::string_view bytes);

}  // namespace gpo
