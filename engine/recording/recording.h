// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/base/eigen_layout.h"
#include "engine/files/paths.h"
#include "engine/geometry/camera.h"
#include "engine/recording/frame_cache.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "engine/window/tracks.h"

#include <map>
#include <memory>
#include <set>

namespace gpo {

enum class CameraSource { file, self_calibrated, guess };

template <>
struct ChoiceKeys<CameraSource> : NamedKeys<"camera source", "file", "self-calibrated", "guess"> {};

/// ArUco markers in the white squares of a board.
struct BoardMarkers {
  double side_m = 0;       ///< side of a marker including its black border
  std::string dictionary;  ///< OpenCV's name, "DICT_5X5_100"
};

/// A grid of AprilTags (36h11) as Kalibr prints it, or a single one.
struct BoardTags {
  double spacing = 0;          ///< gap between two tags, in sides of a tag [-]
  int border = 2;              ///< width of the black border around a tag's code [bits]
  std::optional<int> alone{};  ///< number of a single tag, or kAnyTag; nullopt: a grid
  static constexpr int kAnyTag = -1;
};

/// A chessboard, a ChArUco board (with markers) or a board of tags on the true plane.
struct Board {
  int columns = 0;                        ///< inner corners along a row; two for each tag
  int rows = 0;                           ///< inner corners along a column; two for each tag
  double square_m = 0;                    ///< side of a square, or of a tag
  std::optional<BoardMarkers> markers{};  ///< only for a ChArUco board
  std::optional<BoardTags> tags{};        ///< only for a board of tags
};

/// A file of a recording, or the first file of a sequence, and what became of it.
struct FoundFile {
  fs::path file;
  std::string use;                  ///< "calibration (Kalibr)"; empty: not read
  std::string reason;               ///< why it was not read, or details
  std::vector<fs::path> members{};  ///< all files of the sequence that `file` begins
};

/// A recording, immutable once opened. Threads share it by shared_ptr<const>.
struct Recording {
  fs::path path;
  std::string name;    ///< last component of the path
  std::string layout;  ///< title of the layout, for people: "EuRoC"
  Camera camera;
  CameraSource camera_source = CameraSource::file;
  double pixel_aspect = 1;  ///< width of a pixel divided by its height, as a video states it
  /// "top" or "bottom" if its video is interlaced, of which the images are the first fields.
  std::string first_field;
  std::optional<Pose> T_body_camera;        ///< body: the axes of the IMU; nullopt if unknown
  std::vector<std::int64_t> timestamps_ns;  ///< times of the frames, strictly ascending
  bool complete = true;  ///< false: the first frames of a long video, to be shown while it is read
  std::shared_ptr<const FrameCache> images;  ///< null if there are only tracks
  /// Files of the images: a video, a bag, or one for each frame; empty if none.
  std::vector<fs::path> image_files;
  /// Clockwise, from the images to how people see them: the orientation in the first image's EXIF.
  int quarter_turns = 0;
  std::optional<Gyroscope> gyroscope;
  std::optional<GroundTruth> truth;  ///< from a file; truth from a board is computed on demand
  std::optional<Plane> plane;        ///< true plane in the truth's world
  std::optional<Board> board;
  std::vector<TrackObservation> tracks;  ///< sorted by frame, then track; empty: use the tracker
  std::vector<std::string> notes;        ///< "no gyroscope: ...", each shown once to the user
  std::set<fs::path> read_files;         ///< from which all but the images was read
  std::vector<FoundFile> files;          ///< reported by the readers of layouts; see `found_files`
  fs::path cache_folder;                 ///< for detections in images; empty: do not cache

  int frame_count() const { return static_cast<int>(timestamps_ns.size()); }
};

/// A recording's parts by name ("fx", "truth", "pictures"), each as a text that identifies its
/// content independently of the recording's path: numbers as they are, long data as SHA-256.
/// Missing parts have no entry.
using RecordingContent = std::map<std::string, std::string>;

/// Identifies images by file names and bytes, or, beyond 64 MiB, by names, sizes, times of change
/// and sampled bytes; rendered images also by their recipe. Throws InputError if an image file is
/// missing.
RecordingContent content_of(const Recording& recording);

std::string text_of(const Board& board);

/// Returns the names of the parts that differ or exist in one recording only.
std::vector<std::string> differing_parts(const RecordingContent& a, const RecordingContent& b);

// Kinds of files by their extensions, in upper or lower case.

bool is_image_name(const fs::path& file);
bool is_video_name(const fs::path& file);
bool is_bag_name(const fs::path& file);
std::string recording_endings();

bool is_yaml_name(const fs::path& file);
/// Any YAML file but rosbag2's metadata.yaml.
bool is_recipe(const fs::path& path);

/// Returns the files of a folder that `is_kind` accepts, sorted by path. Throws InputError.
std::vector<fs::path> files_of_kind(const fs::path& folder,
                                    const std::function<bool(const fs::path& file)>& is_kind);
/// Returns the only file; nullopt if there is none. Throws InputError for several `things`.
std::optional<fs::path> only_file(const std::vector<fs::path>& files,
                                  const char* things,
                                  const fs::path& folder);

}  // namespace gpo
