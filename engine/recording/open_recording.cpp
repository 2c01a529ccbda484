// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/error.h"
#include "engine/recording/euroc_reader.h"
#include "engine/recording/pictures_reader.h"
#include "engine/recording/recording.h"
#include "engine/recording/sidecar_files.h"
#include "engine/recording/video_file.h"

#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

namespace fs = std::filesystem;

/// What there is to open, once it is known which layout it has.
struct Found {
  fs::path path;    ///< of the layout: the folder that holds cam0, a video, a folder
  fs::path folder;  ///< where the optional files are looked for first
  bool euroc = false;
  std::optional<fs::path> tracks;
};

std::optional<fs::path> existing(const fs::path& file) {
  return fs::exists(file) ? std::optional(file) : std::nullopt;
}

Found find_in_folder(const fs::path& folder, const OpenOptions& options) {
  Found found{folder, folder, false, options.tracks};
  if (!found.tracks) found.tracks = existing(folder / "tracks.csv");
  for (const fs::path& base : {folder, folder / "mav0"}) {
    if (!fs::exists(base / "cam0")) continue;
    found.path = base;
    found.euroc = true;
    if (!found.tracks) found.tracks = existing(base / "tracks.csv");
    if (!options.tracks && found.tracks && !euroc_lacks_pictures(base)) found.tracks.reset();
    return found;
  }
  const bool pictures = holds_pictures(folder);
  if (!pictures && !found.tracks) {
    throw InputError(folder.string() +
                     ": found no recording, expected cam0/data.csv (EuRoC), a video or numbered "
                     "pictures with camera.yaml, or tracks.csv");
  }
  if (!options.tracks && pictures) found.tracks.reset();
  return found;
}

Found find_recording(const fs::path& path, const OpenOptions& options) {
  if (!fs::exists(path)) throw InputError(path.string() + ": no such file or folder");
  if (fs::is_directory(path)) return find_in_folder(path, options);
  if (!is_video_name(path)) {
    throw InputError(path.string() +
                     ": found a file that is no video, expected a folder or mp4, avi, mov, mkv");
  }
  return {path, path.parent_path(), false, options.tracks};
}

void add_sidecars(Recording& recording, const Found& found) {
  const auto beside = [&](const char* name) {
    auto file = existing(found.folder / name);
    return !file && found.euroc ? existing(found.path / name) : file;
  };
  if (const auto file = beside("board.yaml")) recording.board = read_board(*file);
  if (const auto file = beside("plane.yaml")) recording.plane = read_plane(*file);
  // Truth that comes from the board has the board's frame, z into the board.
  if (!recording.truth && recording.board && recording.pictures) {
    recording.plane = Plane{{0, 0, -1}, 0};
  }
}

void add_notes(Recording& recording) {
  auto& notes = recording.notes;
  if (!recording.pictures)
    notes.emplace_back("no pictures: tracks are drawn on a plain background");
  if (!recording.gyroscope) notes.emplace_back("no gyroscope: rotations from rotation averaging");
  const bool from_board = !recording.truth && recording.board && recording.pictures;
  if (from_board) {
    notes.emplace_back(fmt::format("no stored ground truth: it is computed from the {}",
                                   recording.board->markers ? "ChArUco board" : "chessboard"));
  }
  if (!from_board && !recording.truth) {
    notes.emplace_back("no ground truth: no metrics");
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
  Recording recording = found.euroc ? read_euroc(found.path, found.tracks, options.cache_bytes)
                                    : read_pictures(found.path, found.tracks, options.cache_bytes);
  recording.path = path;
  recording.name = name_of(path);
  add_sidecars(recording, found);
  add_notes(recording);
  if (recording.pictures) recording.pictures->bgr(0);  // a wrong size or format shows here
  return std::make_shared<const Recording>(std::move(recording));
}

}  // namespace gpo
