// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

/// What was recorded, immutable once opened. Shared between threads by shared_ptr<const>.
struct Recording {
  std::filesystem::path path;
  std::string name;    ///< last component of the path
  std::string layout;  ///< for people: "EuRoC"; the titles in the table of layouts
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
  /// Where what was found in the pictures is kept for the next time; empty: nowhere.
  std::filesystem::path cache_folder;

  int frame_count() const { return static_cast<int>(timestamps_ns.size()); }
};

}  // namespace gpo
