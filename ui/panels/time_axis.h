// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Frames along a bar from `left` to `right` [screen px]; each has a slot of equal width.
struct TimeAxis {
  float left = 0, right = 0;
  int frames = 1;
};

/// Where the slot of a frame begins; that of `frames` is the bar's end.
float slot_begin(const TimeAxis& axis, int frame);
float slot_middle(const TimeAxis& axis, int frame);

/// The frame under x, the first or last one beyond the bar's ends.
int frame_at(const TimeAxis& axis, float x);

}  // namespace gpo
