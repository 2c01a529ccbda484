// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/layouts.h"

#include "engine/files/folder.h"
#include "engine/recording/layouts/bag_reader.h"
#include "engine/recording/layouts/euroc_reader.h"
#include "engine/recording/layouts/pictures_reader.h"
#include "engine/recording/layouts/tum_reader.h"

#include <array>

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

}  // namespace

std::span<const Layout> layouts() {
  static constexpr auto kLayouts = std::to_array<Layout>(
      {{"EuRoC", "cam0/data.csv (EuRoC)", "", find_euroc, has_euroc_pictures, read_euroc},
       {"TUM RGB-D", "rgb.txt (TUM RGB-D)", "rgb.txt", find_tum, always, read_tum},
       {"pictures", "a video or numbered pictures", "", find_pictures, always, read_pictures},
       {"ROS bag", "a bag of ROS (bag, db3, mcap)", "", find_bag, always, nullptr, read_bag},
       {"tracks", "tracks.csv", "tracks.csv", any_folder, never, read_pictures}});
  return kLayouts;
}

}  // namespace gpo
