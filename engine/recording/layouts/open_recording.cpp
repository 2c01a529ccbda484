// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/open_recording.h"

#include "engine/base/error.h"
#include "engine/files/folder.h"
#include "engine/recording/board/board_pose.h"
#include "engine/recording/companions/sidecar_files.h"
#include "engine/recording/file_kinds.h"
#include "engine/recording/rest.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {

namespace {

namespace fs = std::filesystem;

/// What there is to open, once it is known which layout it has.
struct Found {
  const Layout* layout;
  fs::path path;    ///< of the layout: the folder that holds cam0 or rgb.txt, a video, a folder
  fs::path folder;  ///< where the optional files are looked for first
  std::optional<fs::path> tracks;
};

/// Tracks beside pictures are used only where they are asked for.
std::optional<fs::path> tracks_of(const Found& found, const OpenOptions& options) {
  if (options.tracks) return options.tracks;
  auto tracks = if_file(found.folder / "tracks.csv");
  if (!tracks) tracks = if_file(found.path / "tracks.csv");
  return tracks && !found.layout->has_pictures(found.path) ? tracks : std::nullopt;
}

/// A folder, or a file that is a recording by itself; nothing where it has no layout.
std::optional<Found> find_layout(const fs::path& path, const OpenOptions& options) {
  const fs::path folder = is_folder(path) ? path : folder_of(path);
  for (const Layout& layout : layouts()) {
    const auto place = layout.find(path);
    if (!place) continue;
    Found found{&layout, *place, folder, {}};
    found.tracks = tracks_of(found, options);
    const bool tracks_alone = &layout == &layouts().back();
    if (!tracks_alone || found.tracks) return found;
  }
  return std::nullopt;
}

/// "cam0/data.csv (EuRoC), rgb.txt (TUM RGB-D), ..., or tracks.csv".
std::string expected_layouts() {
  std::string text;
  for (const Layout& layout : layouts())
    text += fmt::format("{}{}{}",
                        text.empty() ? "" : ", ",
                        &layout == &layouts().back() ? "or " : "",
                        layout.expected);
  return text;
}

Found find_in_folder(const fs::path& folder, const OpenOptions& options) {
  if (const auto found = find_layout(folder, options)) return *found;
  throw InputError(folder.string() + ": found no recording, expected " + expected_layouts());
}

/// The file stands for its folder; tracks that are named are wanted, even where there are pictures.
Found find_around(const fs::path& file, OpenOptions options) {
  if (file.filename() == "tracks.csv" && !options.tracks) options.tracks = file;
  return find_in_folder(folder_of(file), options);
}

bool stands_for_folder(const fs::path& file) {
  return std::ranges::any_of(layouts(),
                             [&](const Layout& layout) { return file.filename() == layout.file; });
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
  if (fs::is_regular_file(status)) {
    if (stands_for_folder(path)) return find_around(path, options);
    if (const auto found = find_layout(path, options)) return *found;
  }
  throw InputError(path.string() +
                   ": found a file that is no video, expected a folder, tracks.csv, rgb.txt or " +
                   recording_endings());
}

Recording read(const Found& found, const OpenOptions& options) {
  if (!found.layout->has_topics && !options.topics.empty()) {
    throw InputError(fmt::format("{}: found {} and no topics, expected a bag for --topic",
                                 found.path.string(),
                                 found.layout->title));
  }
  OpenOptions with_tracks = options;
  with_tracks.tracks = found.tracks;
  return found.layout->read(found.path, with_tracks);
}

bool is_recording_file(const fs::path& path) { return is_video_name(path) || is_bag_name(path); }

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

/// Of a gyroscope of which no file says more than that it has one.
void take_bias_from_rest(Recording& recording) {
  if (!recording.gyroscope || recording.gyroscope->bias_known) return;
  const auto rest = find_rest(recording);
  if (!rest) return;
  Gyroscope& gyroscope = *recording.gyroscope;
  gyroscope.bias_rad_s = rest->mean_rad_s;
  gyroscope.bias_sigma_rad_s = rest->sigma_rad_s;
  gyroscope.bias_source = fmt::format("a rest of {:.1f} s, certain to {:.4f} rad/s",
                                      1e-9 * static_cast<double>(rest->last_ns - rest->first_ns),
                                      rest->sigma_rad_s);
}

bool has_value(const std::optional<Pose>& pose) { return pose.has_value(); }

void add_notes(Recording& recording) {
  auto& notes = recording.notes;
  if (!recording.pictures)
    notes.emplace_back("no pictures: tracks are drawn on a plain background");
  if (!recording.tracks.empty() && recording.tracks.front().frame > 0)
    notes.push_back(fmt::format("tracks begin in frame {}", recording.tracks.front().frame));
  if (!recording.gyroscope) notes.emplace_back("no gyroscope: rotations from the pictures alone");
  const bool from_board = !recording.truth && recording.board && recording.pictures;
  if (from_board) {
    notes.emplace_back(fmt::format("no stored ground truth: it is computed from the {}",
                                   board_title(*recording.board)));
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
  Recording recording = read(found, options);
  recording.layout = (recording.pictures ? *found.layout : layouts().back()).title;
  recording.path = path;
  recording.cache_folder = options.cache_folder;
  recording.name = name_of(is_recording_file(path) || is_folder(path) ? path : found.folder);
  add_sidecars(recording, found);
  take_bias_from_rest(recording);
  add_notes(recording);
  if (recording.pictures) recording.pictures->bgr(0);  // a wrong size or format shows here
  return std::make_shared<const Recording>(std::move(recording));
}

}  // namespace gpo
