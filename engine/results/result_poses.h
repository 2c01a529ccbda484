// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/methods/recording_method.h"

namespace gpo {

/// The moving frame of the poses: the camera or the body (axes of the IMU).
enum class PosedFrame { camera, body };

template <>
struct ChoiceKeys<PosedFrame> : NamedKeys<"frame", "camera", "body"> {};

/// The key that matches poses to the frames of a recording.
enum class FoundBy { time, number, name };

/// Poses estimated by another program, in its own world and scale.
struct ResultPoses {
  std::string layout;                       ///< for people: "COLMAP"
  PosedFrame frame = PosedFrame::camera;    ///< default of the layout
  FoundBy by = FoundBy::time;               ///< number: pose 0 is frame 0 of the recording
  std::vector<std::int64_t> timestamps_ns;  ///< by time: one per pose, strictly ascending
  std::vector<std::string> names = {};      ///< by name: one image per pose, with '/'
  std::vector<Pose> poses;                  ///< world from camera, or from body
  int repeats = 0;                          ///< rows left out, with the time of the row before
  int unmeasured = 0;                       ///< rows left out, not finite
};

/// TUM, EuRoC, VINS-Mono, KITTI, or COLMAP's images.txt, images.bin or folder. Throws InputError.
ResultPoses read_result_poses(const fs::path& path);

bool has_points(const fs::path& folder);

/// Reads points (3 x n): PLY, or COLMAP's points3D.txt, points3D.bin or folder. Throws InputError.
Eigen::Matrix3Xd read_result_points(const fs::path& path);

/// Reads the vertices of a PLY file, ascii or binary little-endian. Throws InputError.
Eigen::Matrix3Xd read_ply_points(const fs::path& file, std::string_view bytes);

/// images.txt, or images.bin if `file` ends with .bin; names are "cam0/1.png". Throws InputError.
ResultPoses read_colmap_images(const fs::path& file, std::string_view bytes);

}  // namespace gpo
