// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/layouts/glance.h"

#include "engine/recording/layouts/layouts.h"

#include <exception>

namespace gpo {
namespace {

namespace fs = std::filesystem;

void count_frames(const Layout& layout, const fs::path& found, Glance& result) {
  try {
    const Recording recording = layout.read != nullptr
                                    ? layout.read(found, std::nullopt, 0)
                                    : layout.read_topics(found, std::nullopt, 0, {});
    result.frames = recording.frame_count();
    if (result.frames == 0) return;
    const auto& times_ns = recording.timestamps_ns;
    result.seconds = 1e-9 * static_cast<double>(times_ns.back() - times_ns.front());
  } catch (const std::exception&) {
    // It says why when it is opened.
  }
}

}  // namespace

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
