// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/other_decomposition.h"

#include "engine/geometry/homography_decomposition.h"
#include "engine/geometry/plane.h"

#include <algorithm>
#include <vector>

namespace gpo {
namespace {

/// Two readings nearer than this are one.
constexpr double kLeastTwin_deg = 3;
/// A reading farther from the twin's normal is none of its own.
constexpr double kMostAstray_deg = 20;

std::vector<HomographyMotion> decompositions_of(const Window& window, int frame) {
  const Eigen::Matrix3d& H = window.H_i1[frame];
  if (!H.allFinite()) return {};
  return decompose_homography(
      H, window.K, window.points_px[0](Eigen::all, window.inlier_tracks(frame)));
}

const HomographyMotion* nearest(const std::vector<HomographyMotion>& readings,
                                const Eigen::Vector3d& normal) {
  const auto from = [&](const HomographyMotion& m) { return angle_deg(m.normal, normal); };
  const auto found = std::ranges::min_element(readings, {}, from);
  return found == readings.end() ? nullptr : &*found;
}

}  // namespace

std::optional<PlaneMotion> other_decomposition(const Window& window, const PlaneMotion& motion) {
  const auto widest = std::ranges::max_element(
      motion.tau, {}, [](const Eigen::Vector3d& tau) { return tau.norm(); });
  const auto of_widest = decompositions_of(window, static_cast<int>(widest - motion.tau.begin()));
  if (of_widest.size() < 2) return std::nullopt;
  const auto farthest = std::ranges::max_element(
      of_widest, {}, [&](const HomographyMotion& m) { return angle_deg(m.normal, motion.normal); });
  if (angle_deg(farthest->normal, motion.normal) < kLeastTwin_deg) return std::nullopt;
  PlaneMotion other;
  other.normal = farthest->normal;
  other.tau = motion.tau;
  other.R_wc = motion.R_wc;
  for (int i = 1; i < window.frame_count(); ++i) {
    const auto readings = decompositions_of(window, i);
    const HomographyMotion* reading = nearest(readings, other.normal);
    if (reading == nullptr || angle_deg(reading->normal, other.normal) > kMostAstray_deg) continue;
    other.tau[i] = reading->tau;
    other.R_wc[i] = reading->R_21.transpose();
  }
  return other;
}

}  // namespace gpo
