// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/recording/frame_cache.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace gpo {

/// A video whose every frame was counted and timed by decoding it once.
struct VideoFile {
  std::vector<std::int64_t> timestamps_ns;  ///< one a frame, strictly ascending, first as stored
  std::shared_ptr<const FrameCache> pictures;
};

/// Throws InputError where it cannot be opened, is cut, or has another size than the camera.
/// Frames come out exactly as sequential decoding gives them, in whatever order they are asked for.
VideoFile open_video(const std::filesystem::path& file,
                     const Camera& camera,
                     std::size_t cache_bytes);

/// Whether the file's name ends in mp4, avi, mov or mkv.
bool is_video_name(const std::filesystem::path& file);

}  // namespace gpo
