// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/camera.h"
#include "engine/geometry/plane.h"
#include "engine/recording/frame_cache.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "engine/window/tracks.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Who says what a recording's camera is like.
enum class CameraSource { file, self_calibrated, guess };

template <>
struct ChoiceKeys<CameraSource> {
  static constexpr const char* name = "camera source";
  static constexpr std::array keys{"file", "self-calibrated", "guess"};
};

/// ArUco markers in the light squares of a board.
struct BoardMarkers {
  double side_m = 0;       ///< of a marker, with its black border
  std::string dictionary;  ///< OpenCV's name, "DICT_5X5_100"
};

/// AprilTags (36h11) side by side, as Kalibr prints them; or one alone.
struct BoardTags {
  double spacing = 0;          ///< from a tag to the next, in a tag's sides [-]
  int border = 2;              ///< width of the black border around a tag's code [bits]
  std::optional<int> alone{};  ///< the number of a tag that is alone, or kAnyTag
  static constexpr int kAnyTag = -1;
};

/// A chessboard on the true plane; a ChArUco board, one with markers; or a board of tags, whose
/// corners are those of the tags.
struct Board {
  int columns = 0;                        ///< inner corners along a row; of tags: two a tag
  int rows = 0;                           ///< inner corners along a column; of tags: two a tag
  double square_m = 0;                    ///< side of a square, or of a tag
  std::optional<BoardMarkers> markers{};  ///< of a ChArUco board; none: a plain chessboard
  std::optional<BoardTags> tags{};        ///< of a board of tags
};

/// What was recorded, immutable once opened. Shared between threads by shared_ptr<const>.
struct Recording {
  std::filesystem::path path;
  std::string name;    ///< last component of the path
  std::string layout;  ///< for people: "EuRoC"; the titles in the table of layouts
  Camera camera;
  CameraSource camera_source = CameraSource::file;
  std::optional<Pose> T_body_camera;           ///< body: the axes of the IMU; where it is told
  std::vector<std::int64_t> timestamps_ns;     ///< one a frame, strictly ascending
  std::shared_ptr<const FrameCache> images;  ///< null where there are none
  /// Where `images` come from: a video, or one file a frame; empty where they are not from files.
  std::vector<std::filesystem::path> image_files;
  std::optional<Gyroscope> gyroscope;
  /// Rolling shutter: from the first row to the last, where the camera's log tells it; negative:
  /// the last row first.
  std::optional<double> readout_s;
  std::optional<GroundTruth> truth;  ///< from a file; truth from the board is computed on demand
  std::optional<Plane> plane;        ///< true plane, in the truth's world
  std::optional<Board> board;
  std::vector<TrackObservation> tracks;  ///< sorted by frame, then track; empty: use our tracker
  std::vector<std::string> notes;        ///< "no gyroscope: ...", each said once to the user
  /// Where what was found in the pictures is kept for the next time; empty: nowhere.
  std::filesystem::path cache_folder;

  int frame_count() const { return static_cast<int>(timestamps_ns.size()); }
};

}  // namespace gpo
