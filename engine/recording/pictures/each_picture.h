// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/frame_cache.h"

#include <functional>
#include <stop_token>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// Calls `look(frame, gray)` for each of the frames, on all processors at once. They are decoded in
/// the order given, because a video goes backward only from its beginning again. Once stopped it
/// returns when the pictures at work are done. Throws what decoding and `look` throw.
void for_each_picture(const FrameCache& pictures,
                      const std::vector<int>& frames,
                      const std::stop_token& stop,
                      const std::function<void(int frame, const cv::Mat& gray)>& look);

}  // namespace gpo
