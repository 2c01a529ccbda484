// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/time_axis.h"

#include <algorithm>
#include <cmath>

namespace gpo {

float slot_begin(const TimeAxis& axis, int frame) {
  return axis.left + (axis.right - axis.left) * static_cast<float>(frame) / axis.frames;
}

float slot_middle(const TimeAxis& axis, int frame) {
  return (slot_begin(axis, frame) + slot_begin(axis, frame + 1)) / 2;
}

int frame_at(const TimeAxis& axis, float x) {
  const float slot = (axis.right - axis.left) / static_cast<float>(axis.frames);
  return std::clamp(static_cast<int>(std::floor((x - axis.left) / slot)), 0, axis.frames - 1);
}

}  // namespace gpo
