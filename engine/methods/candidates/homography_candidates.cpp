// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/candidates/homography_candidates.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

double rotation_angle_deg(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return degrees(so3_log(a.transpose() * b).norm());
}

Eigen::Matrix3Xd inlier_rays(const Window& window, int frame) {
  const Eigen::Matrix2Xd points = window.points_px[0](Eigen::all, window.inlier_tracks(frame));
  return window.K.inverse() * points.colwise().homogeneous();
}

}  // namespace

std::vector<HomographyCandidate> decompose_frame(const Window& window, int frame) {
  const Eigen::Matrix3d H = window.K.inverse() * window.H_i1[frame] * window.K;
  const Eigen::Matrix3Xd rays_1 = inlier_rays(window, frame);
  std::vector<HomographyCandidate> candidates;
  for (const HomographyMotion& motion : decompose_homography(H)) {
    const double score = rotation_angle_deg(motion.R_21, window.R_wc[frame].transpose());
    HomographyCandidate candidate{.frame = frame, .motion = motion, .score = score};
    candidate.behind = points_behind(motion, rays_1);
    candidate.of = static_cast<int>(rays_1.cols());
    if (!is_feasible(candidate.behind, candidate.of))
      candidate.reject(
          Rejection::behind_camera,
          fmt::format("points behind the camera ({} of {})", candidate.behind, candidate.of));
    candidates.push_back(std::move(candidate));
  }
  return candidates;
}

void reject_worse_rotations(std::span<HomographyCandidate> candidates) {
  const HomographyCandidate* best = best_of(candidates);
  if (best == nullptr) return;
  const double least_deg = best->score;
  for (HomographyCandidate& candidate : candidates) {
    const double worse_deg = candidate.score - least_deg;
    if (!candidate.taken() || worse_deg < kClearlyWorseDeg ||
        candidate.score < kClearlyWorseFactor * least_deg)
      continue;
    candidate.reject(
        Rejection::rotation,
        fmt::format("rotation {:.1f} deg from the given rotation, {:.1f} deg worse than its twin's",
                    candidate.score,
                    worse_deg));
  }
}

std::vector<std::vector<HomographyCandidate>> candidates_of_window(const Window& window,
                                                                   const std::stop_token& stop) {
  std::vector<std::vector<HomographyCandidate>> candidates(window.frame_count());
  for (int i = 1; i < window.frame_count() && !stop.stop_requested(); ++i) {
    candidates[i] = decompose_frame(window, i);
    reject_worse_rotations(candidates[i]);
  }
  return candidates;
}

const HomographyCandidate* best_of(std::span<const HomographyCandidate> candidates) {
  const HomographyCandidate* best = nullptr;
  for (const HomographyCandidate& candidate : candidates) {
    if (!candidate.taken()) continue;
    if (best == nullptr || candidate.score < best->score) best = &candidate;
  }
  return best;
}

}  // namespace gpo
