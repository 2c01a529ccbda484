// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/open_recording.h"

#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/board/board.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "engine/window/gyroscope_rest.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <numbers>
#include <tuple>
#include <utility>

#include <fmt/ranges.h>

namespace gpo {
namespace {

struct Found {
  const Layout* layout;
  fs::path path;    ///< argument of the layout's reader
  fs::path folder;  ///< searched first for optional files
  std::optional<fs::path> tracks;
};

std::optional<fs::path> tracks_of(const Found& found, const OpenOptions& options) {
  if (options.tracks) return options.tracks;
  auto tracks = first_file({found.folder / "tracks.csv", found.path / "tracks.csv"});
  const Layout& layout = *found.layout;
  const bool lacks_images =
      layout.tracks_alone || (tracks && layout.lacks_images && layout.lacks_images(found.path));
  return lacks_images ? tracks : std::nullopt;
}

std::optional<Found> find_layout(const fs::path& path, const OpenOptions& options) {
  const fs::path folder = is_folder(path) ? path : folder_of(path);
  for (const Layout& layout : layouts()) {
    const auto place = layout.find(path);
    if (!place) continue;
    Found found{&layout, *place, folder, {}};
    found.tracks = tracks_of(found, options);
    if (!layout.tracks_alone || found.tracks) return found;
  }
  return std::nullopt;
}

/// Returns up to three folders with a recording, at most two levels below, as relative paths.
std::vector<std::string> recordings_below(const fs::path& folder) {
  constexpr int kMostEntries = 1000;
  std::vector<std::string> names;
  std::error_code error, none;
  fs::recursive_directory_iterator entry(folder, error);
  for (int k = 0; !error && entry != end(entry) && names.size() < 3; entry.increment(error)) {
    if (++k > kMostEntries) break;
    if (!entry->is_directory(none)) continue;
    const bool found = find_layout(entry->path(), {}).has_value();
    if (found) names.push_back(entry->path().lexically_relative(folder).string());
    if (found || entry.depth() == 1) entry.disable_recursion_pending();
  }
  std::ranges::sort(names);
  return names;
}

Found find_in_folder(const fs::path& folder, const OpenOptions& options) {
  if (const auto found = find_layout(folder, options)) return *found;
  if (const auto below = recordings_below(folder); !below.empty())
    refuse(folder, "found no recording, but in {}. Open such a folder", fmt::join(below, ", "));
  std::vector<std::string> expected;
  for (const Layout& layout : layouts()) expected.emplace_back(layout.expected);
  refuse(folder, "found no recording, expected {}", fmt::join(expected, ", "));
}

Found find_recording(const fs::path& path, const OpenOptions& options) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) refuse(path, "no such file or folder");
  if (error) refuse(path, "cannot be read: {}", error.message());
  if (fs::is_directory(status)) return find_in_folder(path, options);
  if (fs::is_regular_file(status)) {
    const std::string name = path.filename().string();
    if (std::ranges::any_of(layouts(), [&](const Layout& one) { return one.file == name; })) {
      OpenOptions with_tracks = options;
      // A tracks.csv that the user names is always used.
      if (name == "tracks.csv" && !options.tracks) with_tracks.tracks = path;
      return find_in_folder(folder_of(path), with_tracks);
    }
    if (const auto found = find_layout(path, options)) return *found;
  }
  refuse(path,
         "unsupported file, expected a folder, tracks.csv, rgb.txt or a file of type {}",
         recording_endings());
}

Recording read(const Found& found, const OpenOptions& options) {
  if (!found.layout->has_topics && !options.topics.empty())
    refuse(found.path,
           "found the layout {} without topics, expected a bag for --topic",
           found.layout->title);
  OpenOptions with_tracks = options;
  with_tracks.tracks = found.tracks;
  return found.layout->read(found.path, with_tracks);
}

void add_sidecars(Recording& recording, const Found& found) {
  const auto beside = [&](const char* name) {
    return first_file({found.folder / name, found.path / name});
  };
  if (const auto file = beside("board.yaml")) recording.board = read_board(*file);
  if (const auto file = beside("plane.yaml")) recording.plane = read_plane(*file);
  // Truth from the board is in the board's frame, z into the board.
  if (!recording.truth && recording.board && recording.images)
    recording.plane = Plane{{0, 0, -1}, 0};
}

/// A file's bias is kept, unless the interval contradicts it.
void set_bias_from_stationary_interval(Recording& recording) {
  if (!recording.gyroscope) return;
  const auto rest = find_stationary_interval(recording);
  if (!rest) return;
  Gyroscope& gyroscope = *recording.gyroscope;
  if (gyroscope.bias_known) {
    const double apart_rad_s = (gyroscope.bias_rad_s - rest->mean_rad_s).norm();
    const double sigma_rad_s = std::hypot(held_bias_sigma_rad_s(gyroscope), rest->sigma_rad_s);
    if (apart_rad_s <= kMostBiasSigmas * sigma_rad_s) {
      if (gyroscope.bias_sigma_rad_s == kUnknownBiasSigma_rad_s)
        gyroscope.bias_sigma_rad_s = std::hypot(apart_rad_s, rest->sigma_rad_s);
      return;
    }
    recording.notes.push_back(
        fmt::format("the gyroscope's bias by {} is {:.3f} rad/s off that of a stationary interval "
                    "of {:.1f} s, which is used",
                    gyroscope.bias_source,
                    apart_rad_s,
                    1e-9 * static_cast<double>(rest->last_ns - rest->first_ns)));
  }
  gyroscope.bias_known = false;
  gyroscope.bias_rad_s = rest->mean_rad_s;
  gyroscope.bias_sigma_rad_s = rest->sigma_rad_s;
  gyroscope.bias_source = fmt::format("stationary for {:.1f} s, uncertainty {:.4f} rad/s",
                                      1e-9 * static_cast<double>(rest->last_ns - rest->first_ns),
                                      rest->sigma_rad_s);
}

/// Returns why the rates cannot be in rad/s: no camera turns by more than a revolution per second
/// most of the time. The medians of real recordings are 0.1 to 1 rad/s. Empty if they can.
std::string why_implausible_rates(const Gyroscope& gyroscope) {
  constexpr double kMost_rad_s = 2 * std::numbers::pi;
  std::vector<double> sizes;
  for (const Eigen::Vector3d& rate : gyroscope.rates_rad_s) sizes.push_back(rate.norm());
  if (sizes.empty()) return "";
  const double middle = median(std::move(sizes));
  if (middle < kMost_rad_s) return "";
  return fmt::format(
      "the gyroscope's rates have a median of {:.0f} rad/s, {:.1f} revolutions per second: they "
      "may be in another unit, as degrees per second",
      middle,
      middle / (2 * std::numbers::pi));
}

void add_notes(Recording& recording) {
  auto& notes = recording.notes;
  if (!recording.images) notes.emplace_back("no images: tracks are drawn on a plain background");
  if (!recording.tracks.empty() && recording.tracks.front().frame > 0)
    notes.push_back(fmt::format("tracks begin in frame {}", recording.tracks.front().frame));
  if (!recording.gyroscope) notes.emplace_back("no gyroscope: rotations from the images alone");
  const auto has_pose = [](const std::optional<Pose>& pose) { return pose.has_value(); };
  const bool from_board = !recording.truth && recording.board && recording.images;
  if (from_board)
    notes.push_back(fmt::format("no stored ground truth: computing it from the {}",
                                board_title(*recording.board)));
  if (!from_board && !recording.truth)
    notes.emplace_back("no ground truth: no metrics");
  else if (recording.truth && std::ranges::none_of(recording.truth->poses, has_pose))
    notes.push_back(fmt::format("the ground truth covers no frame, and is not used: {}",
                                std::exchange(recording.truth, {})->source));
  else if (!recording.plane)
    notes.emplace_back("no plane.yaml: no plane errors");
  const auto note_left_out = [&](int count, const char* what, const std::string& source) {
    if (count > 0)
      notes.push_back(fmt::format("{}: {} left out: not finite, or with the time of the one before",
                                  source,
                                  counted(count, what)));
  };
  if (const auto& gyroscope = recording.gyroscope) {
    if (std::string why = why_implausible_rates(*gyroscope); !why.empty())
      notes.push_back(std::move(why));
    const fs::path& file = gyroscope->file;
    note_left_out(
        gyroscope->left_out, "sample", (file.parent_path().filename() / file.filename()).string());
  }
  if (!recording.truth) return;
  note_left_out(recording.truth->left_out, "pose", recording.truth->source);
  for (std::string& note : notes_of(recording.truth->jumps, recording.timestamps_ns.front()))
    notes.push_back(std::move(note));
}

std::string name_of(const fs::path& path) {
  const fs::path clean = fs::absolute(path).lexically_normal();
  return (clean.has_filename() ? clean : clean.parent_path()).filename().string();
}

/// Calibration, gyroscope and tracks may be anywhere, so any folder fits.
std::optional<fs::path> any_folder(const fs::path& path) {
  return is_folder(path) ? std::optional(path) : std::nullopt;
}

}  // namespace

std::shared_ptr<const Recording> open_recording(const fs::path& path, const OpenOptions& options) {
  const Budget budget(path);
  const Found found = find_recording(path, options);
  Recording recording = read(found, options);
  recording.layout = recording.images
                         ? found.layout->title
                         : std::ranges::find(layouts(), true, &Layout::tracks_alone)->title;
  recording.path = path;
  recording.cache_folder = options.cache_folder;
  const FileKind kind = kind_of(path);
  const bool whole_path = kind == FileKind::video || kind == FileKind::bag || is_folder(path);
  recording.name = name_of(whole_path ? path : found.folder);
  add_sidecars(recording, found);
  set_bias_from_stationary_interval(recording);
  add_notes(recording);
  recording.quarter_turns = quarter_turns_of_exif(recording.image_files);
  recording.read_files = Budget::files();
  if (recording.images) recording.images->bgr(0);  // detects a wrong size or format
  return std::make_shared<const Recording>(std::move(recording));
}

bool is_read_from(const Recording& recording, const fs::path& file) {
  std::error_code none;
  if (!fs::exists(file, none)) return false;
  const auto is_it = [&](const fs::path& other) { return fs::equivalent(other, file, none); };
  return std::ranges::any_of(recording.read_files, is_it) ||
         std::ranges::any_of(recording.image_files, is_it);
}

void check_not_overwritten(const Recording& recording, const fs::path& output) {
  if (is_read_from(recording, output))
    refuse(output, "belongs to the recording and would be overwritten; choose another file");
}

std::span<const Layout> layouts() {
  static constexpr auto kLayouts = std::to_array<Layout>({{.title = "EuRoC",
                                                           .expected = "cam0/data.csv (EuRoC)",
                                                           .find = find_euroc,
                                                           .read = read_euroc,
                                                           .lacks_images = euroc_lacks_images},
                                                          {.title = "TUM RGB-D",
                                                           .expected = "rgb.txt (TUM RGB-D)",
                                                           .file = "rgb.txt",
                                                           .find = find_tum,
                                                           .read = read_tum},
                                                          {.title = "pictures",
                                                           .expected = "a video or numbered images",
                                                           .find = find_images,
                                                           .read = read_images},
                                                          {.title = "ROS bag",
                                                           .expected = "a ROS bag (bag, db3, mcap)",
                                                           .file = "metadata.yaml",
                                                           .find = find_bag,
                                                           .read = read_bag,
                                                           .has_topics = true},
                                                          {.title = "tracks",
                                                           .expected = "or tracks.csv",
                                                           .file = "tracks.csv",
                                                           .find = any_folder,
                                                           .read = read_images,
                                                           .tracks_alone = true}});
  return kLayouts;
}

PathProbe probe_path(const fs::path& path, std::chrono::milliseconds time_limit) {
  PathProbe result;
  const auto end = std::chrono::steady_clock::now() + time_limit;
  const auto stop_in_time = [&](double /*share*/) {
    if (std::chrono::steady_clock::now() > end) throw InputError("takes too long");
  };
  std::error_code none;
  for (const Layout& layout : layouts()) {
    try {
      const auto found = layout.find(path);
      if (!found || (layout.tracks_alone && !fs::exists(path / layout.file, none))) continue;
      result.layout = layout.title;
      const auto times_ns =
          layout.read(*found, {.tracks = {}, .cache_bytes = 0, .progress = stop_in_time})
              .timestamps_ns;
      result.frames = static_cast<int>(times_ns.size());
      if (!times_ns.empty())
        result.seconds = 1e-9 * static_cast<double>(times_ns.back() - times_ns.front());
    } catch (const std::exception&) {
      // Opening it will report the error.
    }
    if (!result.layout.empty()) break;
  }
  return result;
}

std::vector<TrackObservation> read_tracks(const fs::path& file, std::optional<int> frame_count) {
  const CsvTable table = read_csv(file, {"frame", "track", "x", "y"}, CsvColumns::at_least);
  const auto most_frames = std::min<std::uint64_t>(limits().items, INT32_MAX);
  const int end = frame_count.value_or(static_cast<int>(most_frames));
  std::vector<std::pair<TrackObservation, int>> read;  // with their lines
  read.reserve(table.rows.size());
  const auto sigma = std::ranges::find(table.header, "sigma_px");
  const int sigma_column =
      sigma == table.header.end() ? 0 : static_cast<int>(sigma - table.header.begin());
  for (const auto& row : table.rows) {
    const std::int64_t frame = csv_integer(table, row, 0);
    if (frame < 0 || frame >= end)
      csv_fail(table,
               row.line,
               fmt::format("frame {}", frame),
               fmt::format("0 to {}, the frames of the recording", end - 1));
    const double sigma_px = sigma_column > 0 ? csv_number(table, row, sigma_column) : 0;
    if (sigma_column > 0 && !(sigma_px > 0))
      csv_fail(table, row.line, fmt::format("sigma_px {}", sigma_px), "a number above 0");
    read.push_back({{.frame = static_cast<int>(frame),
                     .track = csv_integer(table, row, 1),
                     .raw_px = {csv_number(table, row, 2), csv_number(table, row, 3)},
                     .sigma_px = sigma_px},
                    row.line});
  }
  const auto key = [](const auto& one) { return std::tuple(one.first.frame, one.first.track); };
  std::ranges::stable_sort(read, {}, key);
  if (const auto twice = std::ranges::adjacent_find(read, {}, key); twice != read.end())
    csv_fail(
        table,
        std::next(twice)->second,
        fmt::format("track {} a second time in frame {}", twice->first.track, twice->first.frame),
        "one row for each frame and track");
  std::vector<TrackObservation> tracks;
  tracks.reserve(read.size());
  for (const auto& [track, line] : read) tracks.push_back(track);
  return tracks;
}

}  // namespace gpo
