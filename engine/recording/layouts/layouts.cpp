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
  static constexpr auto kLayouts = std::to_array<Layout>(
      {{"EuRoC", "cam0/data.csv (EuRoC)", "", find_euroc, has_euroc_pictures, read_euroc},
       {"TUM RGB-D", "rgb.txt (TUM RGB-D)", "rgb.txt", find_tum, always, read_tum},
       {"pictures", "a video or numbered pictures", "", find_pictures, always, read_pictures},
       {"ROS bag", "a bag of ROS (bag, db3, mcap)", "", find_bag, always, read_bag, true},
       {"tracks", "tracks.csv", "tracks.csv", any_folder, never, read_pictures}});
  return kLayouts;
}

Glance glance(const fs::path& path) {
  Glance result;
  std::error_code none;
  for (const Layout& layout : layouts()) {
    try {
      const auto found = layout.find(path);
      // Any folder would do for tracks alone.
      const bool tracks_alone = &layout == &layouts().back();
      if (!found || (tracks_alone && !fs::exists(path / layout.file, none))) continue;
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
