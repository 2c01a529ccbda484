// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/travel.h"

#include <cstddef>

#include <Eigen/LU>
#include <Eigen/SVD>

namespace gpo {
namespace {

constexpr int kMostIterations = 600;  // enough for a plane with a third of the tracks

}  // namespace

Travel::Travel(const Camera& camera, const RansacOptions& ransac, const Frame& reference)
    : camera_(camera), ransac_(ransac), K_(intrinsic_matrix(camera)) {
  ransac_.most_iterations = kMostIterations;
  if (!ransac_.threshold_px) ransac_.threshold_px = usual_threshold_px(camera, {});
  for (std::size_t k = 0; k < reference.ids.size(); ++k)
    reference_px_[reference.ids[k]] =
        undistort(camera, reference.raw_px.col(static_cast<Eigen::Index>(k)));
}

// K^-1 H K ~ R^T (I - tau n^T): its largest and smallest singular values differ by |tau| if the
// middle one is scaled to 1 (Zhang and Hanson 1996).
Travel::Step Travel::to(const Frame& frame) const {
  Eigen::Matrix2Xd from(2, frame.raw_px.cols());
  Eigen::Matrix2Xd at(2, frame.raw_px.cols());
  Step step;
  for (std::size_t k = 0; k < frame.ids.size(); ++k) {
    const auto first = reference_px_.find(frame.ids[k]);
    if (first == reference_px_.end() || !first->second.allFinite()) continue;
    const Eigen::Vector2d now = undistort(camera_, frame.raw_px.col(static_cast<Eigen::Index>(k)));
    if (!now.allFinite()) continue;
    from.col(step.seen) = first->second;
    at.col(step.seen) = now;
    ++step.seen;
  }
  const auto robust = homography_ransac(from.leftCols(step.seen), at.leftCols(step.seen), ransac_);
  if (!robust || !robust->H.allFinite()) return step;
  const Eigen::Vector3d s =
      Eigen::JacobiSVD<Eigen::Matrix3d>(K_.inverse() * robust->H * K_).singularValues();
  const double tau = (s[0] - s[2]) / s[1];
  if (std::isfinite(tau)) step.tau = tau;
  return step;
}

}  // namespace gpo
