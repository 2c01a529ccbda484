// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/open_recording.h"

#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/recording/layouts/euroc_reader.h"
#include "engine/recording/layouts/pictures_reader.h"
#include "engine/recording/layouts/sidecar_files.h"
#include "engine/recording/layouts/tum_reader.h"
#include "engine/recording/pictures/video_file.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

namespace fs = std::filesystem;

/// What there is to open, once it is known which layout it has.
struct Found {
  fs::path path;    ///< of the layout: the folder that holds cam0 or rgb.txt, a video, a folder
  fs::path folder;  ///< where the optional files are looked for first
  Recording (*read)(const fs::path& path,
                    const std::optional<fs::path>& tracks,
                    std::size_t cache_bytes) = read_pictures;
  std::optional<fs::path> tracks;
};

Found find_in_folder(const fs::path& folder, const OpenOptions& options) {
  Found found{folder, folder, read_pictures, options.tracks};
  if (!found.tracks) found.tracks = if_file(folder / "tracks.csv");
  for (const fs::path& base : {folder, folder / "mav0"}) {
    if (!is_folder(base / "cam0")) continue;
    found.path = base;
    found.read = read_euroc;
    if (!found.tracks) found.tracks = if_file(base / "tracks.csv");
    if (!options.tracks && found.tracks && !euroc_lacks_pictures(base)) found.tracks.reset();
    return found;
  }
  const bool listed = is_file(folder / "rgb.txt");
  if (listed) found.read = read_tum;
  const bool pictures = listed || holds_pictures(folder);
  if (!pictures && !found.tracks) {
    throw InputError(folder.string() +
                     ": found no recording, expected cam0/data.csv (EuRoC), rgb.txt (TUM RGB-D), a "
                     "video or numbered pictures with camera.yaml, or tracks.csv");
  }
  if (!options.tracks && pictures) found.tracks.reset();
  return found;
}

/// The file stands for its folder; tracks that are named are wanted, even where there are pictures.
Found find_around(const fs::path& file, OpenOptions options) {
  if (file.filename() == "tracks.csv" && !options.tracks) options.tracks = file;
  return find_in_folder(folder_of(file), options);
}

Found find_recording(const fs::path& path, const OpenOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) {
    throw InputError(path.string() + ": no such file or folder");
  }
  if (error) {
    throw InputError(path.string() + ": found something that cannot be read (" + error.message() +
                     "), expected a recording");
  }
  if (fs::is_directory(status)) return find_in_folder(path, options);
  const bool file = fs::is_regular_file(status);
  if (file && (path.filename() == "tracks.csv" || path.filename() == "rgb.txt")) {
    return find_around(path, options);
  }
  if (file && is_video_name(path)) {
    return {path, folder_of(path), read_pictures, options.tracks};
  }
  throw InputError(path.string() +
                   ": found a file that is no video, expected a folder, tracks.csv, rgb.txt or "
                   "mp4, avi, mov, mkv");
}

void add_sidecars(Recording& recording, const Found& found) {
  const auto beside = [&](const char* name) {
    auto file = if_file(found.folder / name);
    return file ? file : if_file(found.path / name);
  };
  if (const auto file = beside("board.yaml")) recording.board = read_board(*file);
  if (const auto file = beside("plane.yaml")) recording.plane = read_plane(*file);
  // Truth that comes from the board has the board's frame, z into the board.
  if (!recording.truth && recording.board && recording.pictures) {
    recording.plane = Plane{{0, 0, -1}, 0};
  }
}

bool has_value(const std::optional<Pose>& pose) { return pose.has_value(); }

void add_notes(Recording& recording) {
  auto& notes = recording.notes;
  if (!recording.pictures)
    notes.emplace_back("no pictures: tracks are drawn on a plain background");
  if (!recording.tracks.empty() && recording.tracks.front().frame > 0)
    notes.push_back(fmt::format("tracks begin in frame {}", recording.tracks.front().frame));
  if (!recording.gyroscope) notes.emplace_back("no gyroscope: rotations from rotation averaging");
  const bool from_board = !recording.truth && recording.board && recording.pictures;
  if (from_board) {
    notes.emplace_back(fmt::format("no stored ground truth: it is computed from the {}",
                                   recording.board->markers ? "ChArUco board" : "chessboard"));
  }
  if (!from_board && !recording.truth) {
    notes.emplace_back("no ground truth: no metrics");
  } else if (recording.truth && std::ranges::none_of(recording.truth->poses, has_value)) {
    notes.push_back("no frame is within the times of the ground truth, " + recording.truth->source);
  } else if (!recording.plane) {
    notes.emplace_back("no plane.yaml: no errors of the plane");
  }
}

std::string name_of(const fs::path& path) {
  const fs::path clean = fs::absolute(path).lexically_normal();
  return (clean.has_filename() ? clean : clean.parent_path()).filename().string();
}

}  // namespace

std::shared_ptr<const Recording> open_recording(const fs::path& path, const OpenOptions& options) {
  const Found found = find_recording(path, options);
  Recording recording = found.read(found.path, found.tracks, options.cache_bytes);
  recording.path = path;
  recording.name = name_of(is_video_name(path) || is_folder(path) ? path : found.folder);
  add_sidecars(recording, found);
  add_notes(recording);
  if (recording.pictures) recording.pictures->bgr(0);  // a wrong size or format shows here
  return std::make_shared<const Recording>(std::move(recording));
}

}  // namespace gpo
