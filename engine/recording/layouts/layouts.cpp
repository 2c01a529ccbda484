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

bool has_euroc_images(const fs::path& folder) { return !euroc_lacks_images(folder); }

/// The calibration and the gyroscope may lie in any folder; the tracks may come from elsewhere.
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
    // It says why when it is opened.
  }
}

}  // namespace

std::span<const Layout> layouts() {
  static constexpr auto kLayouts =
      std::to_array<Layout>({{.title = "EuRoC",
                              .expected = "cam0/data.csv (EuRoC)",
                              .find = find_euroc,
                              .has_images = has_euroc_images,
                              .read = read_euroc},
                             {.title = "TUM RGB-D",
                              .expected = "rgb.txt (TUM RGB-D)",
                              .file = "rgb.txt",
                              .find = find_tum,
                              .has_images = always,
                              .read = read_tum},
                             {.title = "pictures",
                              .expected = "a video or numbered pictures",
                              .find = find_images,
                              .has_images = always,
                              .read = read_images},
                             {.title = "ROS bag",
                              .expected = "a bag of ROS (bag, db3, mcap)",
                              .find = find_bag,
                              .has_images = always,
                              .read = read_bag,
                              .has_topics = true},
                             {.title = "tracks",
                              .expected = "tracks.csv",
                              .file = "tracks.csv",
                              .find = any_folder,
                              .has_images = never,
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
