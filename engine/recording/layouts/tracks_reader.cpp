// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/csv_table.h"
#include "engine/recording/layouts/layouts.h"
#include "engine/window/tracks.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace gpo {

namespace {

constexpr int kMostFrames = 10'000'000;

}  // namespace

std::vector<TrackObservation> read_tracks(const std::filesystem::path& file,
                                          std::optional<int> frame_count) {
  const CsvTable table = read_csv(file, {"frame", "track", "x", "y"}, CsvColumns::at_least);
  const int end = frame_count.value_or(kMostFrames);
  std::vector<TrackObservation> read;
  read.reserve(table.rows.size());
  for (const auto& row : table.rows) {
    const std::int64_t frame = csv_integer(table, row, 0);
    if (frame < 0 || frame >= end) {
      csv_fail(table,
               row.line,
               "frame " + std::to_string(frame),
               "0 to " + std::to_string(end - 1) + ", the frames of the recording");
    }
    read.push_back({static_cast<int>(frame),
                    csv_integer(table, row, 1),
                    {csv_number(table, row, 2), csv_number(table, row, 3)}});
  }
  const auto key = [](const TrackObservation& o) { return std::tuple(o.frame, o.track); };
  std::vector<std::size_t> order(read.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return key(read[i]); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (key(read[order[i]]) != key(read[order[i - 1]])) continue;
    csv_fail(table,
             table.rows[order[i]].line,
             "track " + std::to_string(read[order[i]].track) + " a second time in frame " +
                 std::to_string(read[order[i]].frame),
             "one row a frame and track");
  }
  std::ranges::sort(read, {}, key);
  return read;
}

}  // namespace gpo
