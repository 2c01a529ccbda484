// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/time_axis.h"

#include <algorithm>
#include <cmath>

namespace gpo {

namespace {

float slot_width(const TimeAxis& axis) {
  const int shown = axis.span.count > 0 ? axis.span.count : axis.frames;
  return (axis.right - axis.left) / static_cast<float>(shown);
}

}  // namespace

float slot_begin(const TimeAxis& axis, int frame) {
  return axis.left + slot_width(axis) * static_cast<float>(frame - axis.span.first);
}

float slot_middle(const TimeAxis& axis, int frame) {
  return (slot_begin(axis, frame) + slot_begin(axis, frame + 1)) / 2;
}

int frame_at(const TimeAxis& axis, float x) {
  // Clamped before it is made an integer: Dear ImGui's place of no pointer is beyond them all.
  const double frame = axis.span.first + std::floor((x - axis.left) / slot_width(axis));
  return static_cast<int>(std::clamp(frame, 0.0, axis.frames - 1.0));
}

}  // namespace gpo
