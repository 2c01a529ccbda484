// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"
#include "engine/geometry/plane.h"
#include "engine/methods/recording_method.h"
#include "engine/recording/companions/colmap_model.h"

namespace gpo {

/// The moving frame of the poses: the camera or the body (axes of the IMU).
enum class PosedFrame { camera, body };

template <>
struct ChoiceKeys<PosedFrame> : NamedKeys<"frame", "camera", "body"> {};

/// The unit of a result: meters or arbitrary.
enum class ResultScale { metric, free };

template <>
struct ChoiceKeys<ResultScale> : NamedKeys<"scale", "metric", "free"> {};

/// The addition to the times of a result.
enum class TimeShift { none, estimated, given };

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

/// Another program's result as named on the command line (see README.md).
struct ProgramResult {
  std::string name;                       ///< key and title of the method
  fs::path poses;                         ///< a trajectory or a COLMAP model
  fs::path points;                        ///< in the same world; empty: none
  std::optional<PosedFrame> frame = {};   ///< nullopt: the default of the layout
  std::optional<ResultScale> scale = {};  ///< nullopt: body poses are metric, camera poses are not
  TimeShift shift = TimeShift::none;
  double shift_s = 0;  ///< if given
};

/// Parses "NAME=FILE[,POINTS][,frame=camera|body][,scale=metric|free][,offset=auto|SECONDS]".
/// Throws InputError.
ProgramResult parse_program_result(const std::string& text);

/// Receives each distinct message about a result's frames, poses and plane once.
using ResultLog = std::function<void(const std::string& name, const std::string& line)>;

/// Returns the result as a method. For each window it has the result's cameras, with missing ones
/// resected, and the plane through the result's points near the window's inlier tracks or, if these
/// are few, through points triangulated from its cameras. Windows that the result does not cover
/// fail with a reason. The time offset is estimated from the whole recording, or else from the
/// window. Reads the files; throws InputError. If the path of the poses contains `{recording}`, the
/// files are those of each recording: the method reads them at the first window of a recording and
/// throws InputError if it has none. `number` as for `own_method`.
Method result_method(const ProgramResult& result, const ResultLog& log, int number);

/// Returns the plane, in the map's world, through the map's points (3 x n) that the reference
/// camera sees within 2 deg of an inlier track, by RANSAC with a fixed seed; nullopt for fewer than
/// 10 such points. The map may be larger than the window and have other planes.
std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window);

}  // namespace gpo
