// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/topic_roles.h"
#include "engine/recording/recording.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>

namespace gpo {

/// One way in which recordings are stored.
struct Layout {
  const char* title;     ///< for people: "EuRoC"
  const char* expected;  ///< by what it is recognized, in a list: "cam0/data.csv (EuRoC)"
  const char* file;      ///< the name of a file in it that stands for the folder; empty: none does
  /// What `read` wants, where the path (a folder, or one file) has this layout.
  std::optional<std::filesystem::path> (*find)(const std::filesystem::path& path);
  /// Whether it has pictures, so that tracks beside them are not wanted unless asked for.
  bool (*has_pictures)(const std::filesystem::path& found);
  /// Throws InputError. With `tracks` pictures may be missing.
  Recording (*read)(const std::filesystem::path& found,
                    const std::optional<std::filesystem::path>& tracks,
                    std::size_t cache_bytes);
  /// Instead of `read`, where there are topics to choose from.
  Recording (*read_topics)(const std::filesystem::path& found,
                           const std::optional<std::filesystem::path>& tracks,
                           std::size_t cache_bytes,
                           const TopicChoices& choices) = nullptr;
};

/// All of them, in the order in which they are tried. The last one is tracks alone, for what has
/// tracks and no other layout.
std::span<const Layout> layouts();

}  // namespace gpo
