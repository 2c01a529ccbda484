// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/csv_table.h"
#include "engine/files/text_file.h"
#include "engine/recording/layouts/open_recording.h"

#include <algorithm>
#include <array>
#include <exception>
#include <numeric>
#include <tuple>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr int kMostFrames = 10'000'000;

/// Calibration, gyroscope and tracks may be anywhere, so any folder fits.
std::optional<fs::path> any_folder(const fs::path& path) {
  return is_folder(path) ? std::optional(path) : std::nullopt;
}

void count_frames(const Layout& layout, const fs::path& found, PathProbe& result) {
  try {
    const Recording recording = layout.read(found, {.tracks = {}, .cache_bytes = 0});
    result.frames = recording.frame_count();
    if (result.frames == 0) return;
    const auto& times_ns = recording.timestamps_ns;
    result.seconds = 1e-9 * static_cast<double>(times_ns.back() - times_ns.front());
  } catch (const std::exception&) {
    // Opening it will report the error.
  }
}

}  // namespace

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
                                                           .find = find_bag,
                                                           .read = read_bag,
                                                           .has_topics = true},
                                                          {.title = "tracks",
                                                           .expected = "tracks.csv",
                                                           .file = "tracks.csv",
                                                           .find = any_folder,
                                                           .read = read_images,
                                                           .tracks_alone = true}});
  return kLayouts;
}

PathProbe probe_path(const fs::path& path) {
  PathProbe result;
  std::error_code none;
  for (const Layout& layout : layouts()) {
    try {
      const auto found = layout.find(path);
      if (!found || (layout.tracks_alone && !fs::exists(path / layout.file, none))) continue;
      result.layout = layout.title;
      count_frames(layout, *found, result);
      return result;
    } catch (const std::exception&) {
      continue;
    }
  }
  return result;
}

std::vector<TrackObservation> read_tracks(const fs::path& file, std::optional<int> frame_count) {
  const CsvTable table = read_csv(file, {"frame", "track", "x", "y"}, CsvColumns::at_least);
  const int end = frame_count.value_or(kMostFrames);
  std::vector<TrackObservation> read;
  read.reserve(table.rows.size());
  for (const auto& row : table.rows) {
    const std::int64_t frame = csv_integer(table, row, 0);
    if (frame < 0 || frame >= end)
      csv_fail(table,
               row.line,
               fmt::format("frame {}", frame),
               fmt::format("0 to {}, the frames of the recording", end - 1));
    read.push_back({static_cast<int>(frame),
                    csv_integer(table, row, 1),
                    {csv_number(table, row, 2), csv_number(table, row, 3)}});
  }
  const auto key = [](const TrackObservation& o) { return std::tuple(o.frame, o.track); };
  std::vector<std::size_t> order(read.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return key(read[i]); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const TrackObservation& o = read[order[i]];
    if (key(o) == key(read[order[i - 1]]))
      csv_fail(table,
               table.rows[order[i]].line,
               fmt::format("track {} a second time in frame {}", o.track, o.frame),
               "one row for each frame and track");
  }
  std::ranges::sort(read, {}, key);
  return read;
}

}  // namespace gpo
