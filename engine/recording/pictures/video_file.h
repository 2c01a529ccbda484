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

struct VideoFile {
  std::vector<std::int64_t> timestamps_ns;  ///< one a frame, strictly ascending, the first is 0
  std::shared_ptr<const FrameCache> pictures;
  double first_frame_s = 0;  ///< when the container has it
  int quarter_turns = 0;     ///< of the pictures, clockwise, from how they lie in the file
};

/// Opens a video without decoding it; times are the container's, also of a variable frame rate. The
/// camera's size is the video's where the calibration does not tell it. Throws InputError where it
/// cannot be opened, is cut, or has another size than the camera.
VideoFile open_video(const std::filesystem::path& file, Camera& camera, std::size_t cache_bytes);

}  // namespace gpo
