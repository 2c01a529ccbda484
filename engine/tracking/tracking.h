// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

namespace gpo {

/// How corners are tracked: from each frame to the next, as the paper does, or by their template in
/// the reference frame, so that they do not drift (engine/method.md, "Tracks").
enum class Tracking { frame_to_frame, anchored };

/// Frames of a window.
struct FrameSpan {
  int start = 0;  ///< reference frame, counts in the recording
  int frames = 0;

  bool operator==(const FrameSpan&) const = default;
};

template <>
struct ChoiceKeys<Tracking> : NamedKeys<"tracking", "frame-to-frame", "anchored"> {};

}  // namespace gpo
