// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/live_progress.h"

#include "engine/geometry/pose.h"

#include <cmath>
#include <utility>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kMostIterations = 600;   // enough for a plane with a third of the tracks
constexpr double kMostTurnSigmas = 4;  // rotation of the normal that a later answer may cause
constexpr double kLonger = 1.5;  // length of a window that may improve an answer, to the last one

/// Returns why an outcome does not replace the answer; empty if it does.
std::string why_not_better(const LiveProgress& progress, int length, const LiveOutcome& outcome) {
  if (!outcome.is_ready())
    return fmt::format("the window of {} frames is not ready: {}", length, outcome.why_not_ready());
  const Initialization& first = progress.first->initialization;
  const double sigma_deg = first.verdict->normal_sigma_deg.value_or(0);
  const double apart_deg =
      angle_deg(first.plane.normal, outcome.result->initialization.plane.normal);
  if (apart_deg <= kMostTurnSigmas * sigma_deg) return "";
  return fmt::format(
      "the normals of {} and {} frames differ by {:.2f} deg, {:.1f} standard deviations",
      progress.status.ready_frames,
      length,
      apart_deg,
      apart_deg / sigma_deg);
}

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

bool LiveProgress::worth_solving(int length) const {
  return !status.ready || length >= kLonger * status.solved_frames;
}

void LiveProgress::take(int length, LiveOutcome outcome) {
  status.solved_frames = length;
  if (status.ready) {
    status.reason = why_not_better(*this, length, outcome);
  } else {
    status.reason = outcome.why_not_ready();
    if (!outcome.is_ready()) return;
    status.ready = true;
    status.ready_frames = length;
    first = outcome.result;
  }
  if (!status.reason.empty()) return;
  status.metric = outcome.result->is_metric();
  status.answer = std::move(outcome.result);
}

}  // namespace gpo
