// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/geometry/plane.h"
#include "engine/methods/methods.h"

namespace gpo {

/// The moving frame of the poses: the camera or the body (axes of the IMU).
enum class PosedFrame { camera, body };

template <>
struct ChoiceKeys<PosedFrame> {
  static constexpr const char* name = "frame";
  static constexpr std::array keys{"camera", "body"};
};

enum class FoundBy { time, number, name };

inline constexpr double kMaxCoordinate = 1e12;

struct ResultPoses {
  std::string layout;                       ///< for people: "COLMAP"
  PosedFrame frame = PosedFrame::camera;    ///< default of the layout
  FoundBy by = FoundBy::time;               ///< number: pose 0 is frame 0 of the recording
  std::vector<std::int64_t> timestamps_ns;  ///< by time: one per pose, strictly ascending
  std::vector<std::string> names = {};      ///< by name: one image per pose, with '/'
  std::vector<Pose> poses;                  ///< world from camera, or from body
};

/// Reads a trajectory: TUM, also with the nanoseconds of ORB-SLAM3 (8 numbers with blanks), EuRoC
/// and VINS-Mono (8 or more with commas), KITTI (12 with blanks), or COLMAP's images.txt,
/// images.bin or model folder. Throws InputError.
ResultPoses read_result_poses(const fs::path& path);

bool has_points(const fs::path& folder);

/// Reads points (3 x n): PLY, or COLMAP's points3D.txt, points3D.bin or folder. Throws InputError.
Eigen::Matrix3Xd read_result_points(const fs::path& path);

/// Reads the vertices of a PLY file, ascii or binary little-endian. Throws InputError.
Eigen::Matrix3Xd read_ply_points(const fs::path& file, std::string_view bytes);

/// Reads images.txt or, if `file` ends with .bin, images.bin; names are "cam0/1.png". Throws
/// InputError that names the line, or the image and its first byte.
ResultPoses read_colmap_images(const fs::path& file, std::string_view bytes);

/// Reads the positions (3 x n) in points3D.txt or points3D.bin. Throws InputError likewise.
Eigen::Matrix3Xd read_colmap_points(const fs::path& file, std::string_view bytes);

struct ProgramResult {
  std::string name;                      ///< key and title of the method
  fs::path poses;                        ///< a trajectory or a COLMAP model
  fs::path points;                       ///< in the same world; empty: none
  std::optional<PosedFrame> frame = {};  ///< nullopt: the default of the layout
};

/// Parses "NAME=FILE[,POINTS][,frame=camera|body]". Throws InputError.
ProgramResult parse_program_result(const std::string& text);

using ResultLog = std::function<void(const std::string& name, const std::string& line)>;

/// For each window it has the result's cameras, missing ones resected, and the plane through its
/// points near inlier tracks or, if these are few, through triangulated points. Windows that it
/// does not cover fail with a reason. Throws InputError. `number` as for `own_method`.
Method result_method(const ProgramResult& result, const ResultLog& log, int number);

/// Returns the plane, in the map's world, through the points (3 x n) that the reference camera sees
/// within 2 deg of an inlier track, by RANSAC; nullopt for fewer than 10 such points.
std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window);

}  // namespace gpo
