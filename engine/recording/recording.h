// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/recording/pictures/frame_cache.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

enum class Layout { euroc, tum_rgbd, pictures, tracks };  ///< contract.md's layouts 1 to 4

/// A gyroscope's samples, strictly ascending in time, all finite.
struct Gyroscope {
  std::filesystem::path file;
  std::vector<std::int64_t> timestamps_ns;
  std::vector<int> lines;                    ///< of each sample in `file`, for messages about a gap
  std::vector<Eigen::Vector3d> rates_rad_s;  ///< in the gyroscope's own axes
  std::vector<Eigen::Vector3d>
      accelerations_m_s2;  ///< as many, or none; only handed on by `convert`
  Eigen::Matrix3d R_gyro_camera = Eigen::Matrix3d::Identity();  ///< camera axes -> gyroscope axes
  std::int64_t time_offset_ns = 0;  ///< gyroscope clock = camera clock + offset
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();
  double bias_sigma_rad_s = 0.01;  ///< each axis; by default as a phone's own calibration leaves it
  std::string bias_source = "none: zero";  ///< where the bias comes from, for people
};

/// How sure a pose is that was computed from a picture of a board: standard deviations, roots of
/// the covariances' traces, from the noise that the fit's residuals show. Of an error in the
/// calibration, in the board's size or its flatness they know nothing.
struct PoseUncertainty {
  double rms_px = 0;              ///< distance of the board's corners from where the pose puts them
  double position_sigma_m = 0;    ///< of the camera in the board's frame
  double rotation_sigma_deg = 0;  ///< of the camera
  double normal_sigma_deg = 0;    ///< of the board's normal in the camera's frame
};

/// True camera poses, one entry a frame; nothing where a frame has none.
struct GroundTruth {
  std::string source;                                           ///< file name, for people
  std::vector<std::optional<Pose>> poses;                       ///< in the truth's world [m]
  std::vector<std::optional<PoseUncertainty>> uncertainties{};  ///< as `poses`; empty: not known
};

/// ArUco markers in the light squares of a board.
struct BoardMarkers {
  double side_m = 0;       ///< of a marker, with its black border
  std::string dictionary;  ///< OpenCV's name, "DICT_5X5_100"
};

/// A chessboard on the true plane, or a ChArUco board: one with markers.
struct Board {
  int columns = 0;                        ///< inner corners along a row
  int rows = 0;                           ///< inner corners along a column
  double square_m = 0;                    ///< side of a square
  std::optional<BoardMarkers> markers{};  ///< of a ChArUco board; none: a plain chessboard
};

/// One observation of a track that somebody else's front end made.
struct TrackObservation {
  int frame;  ///< counts in the recording
  std::int64_t track;
  Eigen::Vector2d raw_px;
};

/// What was recorded, immutable once opened. Shared between threads by shared_ptr<const>.
struct Recording {
  std::filesystem::path path;
  std::string name;  ///< last component of the path
  Layout layout = Layout::euroc;
  Camera camera;
  std::optional<Pose> T_body_camera;           ///< body: the axes of the IMU; where it is told
  std::vector<std::int64_t> timestamps_ns;     ///< one a frame, strictly ascending
  std::shared_ptr<const FrameCache> pictures;  ///< null where there are none
  /// Where `pictures` come from: a video, or one file a frame; empty where they are not from files.
  std::vector<std::filesystem::path> picture_files;
  std::optional<Gyroscope> gyroscope;
  std::optional<GroundTruth> truth;  ///< from a file; truth from the board is computed on demand
  std::optional<Plane> plane;        ///< true plane, in the truth's world
  std::optional<Board> board;
  std::vector<TrackObservation> tracks;  ///< sorted by frame, then track; empty: use our tracker
  std::vector<std::string> notes;        ///< "no gyroscope: ...", each said once to the user

  int frame_count() const { return static_cast<int>(timestamps_ns.size()); }
};

struct OpenOptions {
  std::optional<std::filesystem::path> tracks;  ///< replaces the built-in tracker
  std::size_t cache_bytes = FrameCache::kDefaultByteLimit;
};

/// Opens a folder or a file; finds out which layout it is. Pictures are not decoded yet, but each
/// is known to exist. Throws InputError.
std::shared_ptr<const Recording> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options = {});

}  // namespace gpo
