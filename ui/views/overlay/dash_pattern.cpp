// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/overlay/dash_pattern.h"

namespace gpo {

using Eigen::Vector2d;

std::vector<std::pair<Vector2d, Vector2d>> dashes_along(std::span<const Vector2d> line,
                                                        std::span<const double> pattern) {
  std::vector<std::pair<Vector2d, Vector2d>> dashes;
  std::size_t phase = 0;
  double left = pattern.front();  // of the pattern's current length
  for (std::size_t i = 1; i < line.size(); ++i) {
    const Vector2d step = line[i] - line[i - 1];
    const double length = step.norm();
    for (double at = 0; at < length;) {
      const bool bends = at + left >= length;  // before the pattern goes on
      const double end = bends ? length : at + left;
      if (phase % 2 == 0)
        dashes.emplace_back(line[i - 1] + at / length * step, line[i - 1] + end / length * step);
      left -= end - at;
      at = end;
      if (bends) continue;
      phase = (phase + 1) % pattern.size();
      left = pattern[phase];
    }
  }
  return dashes;
}

}  // namespace gpo
