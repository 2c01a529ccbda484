// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/time_span.h"

namespace gpo {

/// Frames along a bar from `left` to `right` [screen px]; each that is shown has a slot of equal
/// width.
struct TimeAxis {
  float left = 0, right = 0;
  int frames = 1;      ///< of the recording
  TimeSpan span = {};  ///< what is shown of them
};

/// Where the slot of a frame begins, maybe beyond the bar; that after the last shown is its end.
float slot_begin(const TimeAxis& axis, int frame);
float slot_middle(const TimeAxis& axis, int frame);

/// The frame under x, the first or last one beyond the bar's ends.
int frame_at(const TimeAxis& axis, float x);

}  // namespace gpo
