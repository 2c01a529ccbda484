// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/csv_table.h"
#include "engine/files/folder.h"
#include "engine/recording/companions/calibration_file.h"
#include "engine/recording/companions/truth_file.h"
#include "engine/recording/layouts/layouts.h"
#include "engine/recording/pictures/picture_files.h"

#include <utility>
#include <vector>

namespace gpo {
namespace {

namespace fs = std::filesystem;

void add_pictures(Recording& recording,
                  const fs::path& folder,
                  const CsvTable& list,
                  bool may_be_missing,
                  std::size_t cache_bytes) {
  std::vector<fs::path> files;
  files.reserve(list.rows.size());
  for (const auto& row : list.rows) {
    files.push_back(folder / csv_cell(list, row, 1));
    if (is_file(files.back())) continue;
    if (may_be_missing) return;
    csv_fail(list, row.line, "the name of a missing picture", "the file " + files.back().string());
  }
  add_picture_files(recording, std::move(files), cache_bytes);
}

}  // namespace

std::optional<fs::path> find_tum(const fs::path& folder) {
  return is_file(folder / "rgb.txt") ? std::optional(folder) : std::nullopt;
}

Recording read_tum(const fs::path& folder, const OpenOptions& options) {
  Recording recording;
  const CsvTable list =
      read_csv(folder / "rgb.txt", {"timestamp", ""}, CsvColumns::exactly, Separator::blanks);
  recording.timestamps_ns = csv_time_stamps(list, TimeUnit::seconds);
  recording.camera = read_calibration(calibration_in(folder)).camera;
  add_pictures(recording, folder, list, options.tracks.has_value(), options.cache_bytes);
  if (options.tracks) recording.tracks = read_tracks(*options.tracks, recording.frame_count());
  recording.truth = truth_beside(folder, recording.timestamps_ns);
  return recording;
}

}  // namespace gpo
