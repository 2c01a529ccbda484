// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/layouts.h"

#include "engine/files/folder.h"

#include <array>
#include <exception>

namespace gpo {
namespace {

namespace fs = std::filesystem;

bool always(const fs::path& /*found*/) { return true; }
bool never(const fs::path& /*found*/) { return false; }

bool has_euroc_pictures(const fs::path& folder) { return !euroc_lacks_pictures(folder); }

/// The calibration and the gyroscope may lie in any folder; the tracks may come from elsewhere.
std::optional<fs::path> any_folder(const fs::path& path) {
  return is_folder(path) ? std::optional(path) : std::nullopt;
}

void count_frames(const Layout& layout, const fs::path& found, Glance& result) {
  try {
    const Recording recording = layout.read(found, {.tracks = {}, .cache_bytes = 0});
    result.frames = recording.frame_count();
    if (result.frames == 0) return;
    const auto& times_ns = recording.timestamps_ns;
    result.seconds = 1e-9 * static_cast<double>(times_ns.back() - times_ns.front());
  } catch (const std::exception&) {
    // It says why when it is opened.
  }
}

}  // namespace

std::span<const Layout> layouts() {
  static constexpr auto kLayouts =
      std::to_array<Layout>({{.title = "EuRoC",
                              .expected = "cam0/data.csv (EuRoC)",
                              .find = find_euroc,
                              .has_pictures = has_euroc_pictures,
                              .read = read_euroc},
                             {.title = "TUM RGB-D",
                              .expected = "rgb.txt (TUM RGB-D)",
                              .file = "rgb.txt",
                              .find = find_tum,
                              .has_pictures = always,
                              .read = read_tum},
                             {.title = "pictures",
                              .expected = "a video or numbered pictures",
                              .find = find_pictures,
                              .has_pictures = always,
                              .read = read_pictures},
                             {.title = "ROS bag",
                              .expected = "a bag of ROS (bag, db3, mcap)",
                              .find = find_bag,
                              .has_pictures = always,
                              .read = read_bag,
                              .has_topics = true},
                             {.title = "tracks",
                              .expected = "tracks.csv",
                              .file = "tracks.csv",
                              .find = any_folder,
                              .has_pictures = never,
                              .read = read_pictures,
                              .tracks_alone = true}});
  return kLayouts;
}

Glance glance(const fs::path& path) {
  Glance result;
  std::error_code none;
  for (const Layout& layout : layouts()) {
    try {
      const auto found = layout.find(path);
      // Any folder would do for tracks alone.
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

}  // namespace gpo
