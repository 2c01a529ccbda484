// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/residuals.h"

#include "engine/geometry/homography.h"
#include "engine/window/window.h"

#include <cmath>

#include <Eigen/LU>

namespace gpo {

std::optional<Eigen::Matrix3d> estimated_homography(const Inspection& inspection,
                                                    int frame_in_window) {
  const Window& window = *inspection.window;
  const Initialization& estimate = *inspection.initialization;
  if (!estimate.ok) return std::nullopt;
  const Pose& pose = estimate.cameras[frame_in_window];
  const Eigen::Vector3d tau = -pose.p_wc / estimate.plane.distance;
  return window.K * pose.R_wc.transpose() *
         (Eigen::Matrix3d::Identity() - tau * estimate.plane.normal.transpose()) *
         window.K.inverse();
}

std::vector<double> residuals_px(const Inspection& inspection, int frame_in_window) {
  const auto H = estimated_homography(inspection, frame_in_window);
  if (!H) return {};
  const Window& window = *inspection.window;
  std::vector<double> residuals;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[frame_in_window][j]) continue;
    const Eigen::Vector2d predicted =
        distort(inspection.recording->camera, transfer(*H, window.points_px[0].col(j)));
    const double residual = (predicted - inspection.tracks->raw_px[frame_in_window].col(j)).norm();
    if (std::isfinite(residual)) residuals.push_back(residual);
  }
  return residuals;
}

}  // namespace gpo
