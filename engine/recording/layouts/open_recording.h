// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/topic_roles.h"
#include "engine/recording/recording.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

namespace gpo {

struct OpenOptions {
  std::optional<std::filesystem::path> tracks;  ///< replaces the built-in tracker
  std::size_t cache_bytes = FrameCache::kDefaultByteLimit;
  /// Where what was found in the pictures is kept for the next time; empty: nowhere.
  std::filesystem::path cache_folder{};
  TopicChoices topics{};  ///< of a bag
};

/// Opens a folder or a file; finds out which layout it is. Pictures are not decoded yet, but each
/// is known to exist. Throws InputError.
std::shared_ptr<const Recording> open_recording(const std::filesystem::path& path,
                                                const OpenOptions& options = {});

}  // namespace gpo
