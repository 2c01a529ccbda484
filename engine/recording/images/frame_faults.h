// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <span>

namespace gpo {

/// Why a frame's image does not show the scene at its time stamp.
enum class FrameFault { none, repeated, black, flash };

/// Finds faults in the thumbnails (gray, equal sizes) of successive frames. A frame is repeated if
/// it hardly differs from the one before while the camera moves before and after it; black if it is
/// dark throughout among brighter ones; a flash if it is far brighter or darker than the frames
/// around it, which agree.
std::vector<FrameFault> faults_of(std::span<const cv::Mat> thumbnails);

/// Returns a small copy of a gray image for `faults_of`.
cv::Mat thumbnail_of(const cv::Mat& gray);

/// Names frames with faults for people: "1 (7) are black". `first` is the number of the first one.
std::string text_of(std::span<const FrameFault> faults, int first = 0);

/// Returns whether `leave_out_faulty_frames` searches all frames.
bool is_searched_whole(const Recording& recording);

/// Frames of a long recording that a command uses, and as many after them: they may replace others.
struct SearchedFrames {
  int first = 0;
  int count = 68;
};

inline constexpr SearchedFrames kAllFrames{0, 1 << 30};

/// Removes frames with faults and adds a note that names them. Decodes all images of a recording of
/// at most 400 frames, and only the `searched` ones of a longer one; in numbered files decodes only
/// if sizes of files hint at a fault. Does nothing to recordings with their own tracks, or if an
/// image is broken.
void leave_out_faulty_frames(Recording& recording, const SearchedFrames& searched = {});

}  // namespace gpo
