// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/focal_rate.h"

#include "engine/methods/certainty/solution_moves.h"
#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/rolling_shutter.h"

#include <vector>

namespace gpo {

std::optional<FocalRate> focal_rate(const Window& window, const Initialization& result) {
  if (!result.ok) return std::nullopt;
  const Window at_stamps = as_seen_at_time_stamps(window, result);
  const Eigen::Vector2d center = window.K.topRightCorner<2, 1>();
  std::vector<Eigen::Matrix2Xd> moves_px;  // by a rate of -1 / s
  for (int i = 0; i < window.frame_count(); ++i) {
    const double seconds =
        1e-9 * static_cast<double>(window.timestamps_ns[i] - window.timestamps_ns[0]);
    moves_px.emplace_back(seconds * (at_stamps.points_px[i].colwise() - center));
  }
  const PlaneMotion motion = motion_of(result.plane, result.cameras);
  const PlaneObservations observations = plane_observations(at_stamps);
  const auto found = multiple_of({at_stamps, observations, motion}, RotationModel::free, moves_px);
  if (!found) return std::nullopt;
  return FocalRate{-found->value, found->sigma};
}

}  // namespace gpo
