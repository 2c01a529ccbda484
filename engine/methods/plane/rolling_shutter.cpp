// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/rolling_shutter.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/methods/plane/plane_result.h"

#include <cmath>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Pose pose_after(const PlaneMotion& motion, int frame, const Velocity& velocity, double seconds) {
  return {motion.R_wc[frame] * so3_exp(velocity.rotation_rad(seconds)),
          -(motion.tau[frame] + velocity.tau(seconds))};
}

/// Returns the noise of the poses if each depends on the images of its frame only.
PathNoise path_noise(const Window& window, const PlaneMotion& motion, RotationModel rotations) {
  const bool free = rotations == RotationModel::free;
  const Eigen::Index size = free ? 6 : 3;
  const PlaneObservations observations = plane_observations(window);
  double of_rotations = 0, of_tau = 0, axes = 0;
  for (int i = 1; i < window.frame_count(); ++i) {
    const FrameNormals normals = frame_normals(observations.frames[i],
                                               frame_state(observations, motion, i),
                                               free ? Rotating::yes : Rotating::no);
    const Eigen::MatrixXd inverse = inverse_of_symmetric(normals.JtJ.bottomRightCorner(size, size));
    if (!normals.in_front || !inverse.allFinite()) continue;
    of_tau += inverse.bottomRightCorner<3, 3>().trace();
    if (free) of_rotations += inverse.topLeftCorner<3, 3>().trace();
    axes += 3;
  }
  if (axes == 0) return {};
  const double sigma_px = homography_error_px(window) / kMedianOfRayleigh;
  return {sigma_px * std::sqrt(of_rotations / axes), sigma_px * std::sqrt(of_tau / axes)};
}

/// Returns the plane of each track; nullopt if it is on none.
std::vector<std::optional<Plane>> planes_of_tracks(const Window& window,
                                                   const PlaneMotion& motion) {
  std::vector<std::optional<Plane>> planes(window.track_count());
  for (const std::vector<bool>& inlier : window.inlier)
    for (int j = 0; j < window.track_count(); ++j)
      if (inlier[j]) planes[j] = Plane{motion.normal, 1};
  for (const OtherPlane& other : motion.others)
    for (const int j : window.planes[other.number].tracks)
      planes[j] = Plane{other.m.normalized(), 1 / other.m.norm()};
  return planes;
}

/// Returns the points as they would be seen at the frames' time stamps.
std::vector<Eigen::Matrix2Xd> corrected_px(const Window& window,
                                           const PlaneMotion& motion,
                                           std::span<const Velocity> velocities,
                                           double row_delay_s) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const auto planes = planes_of_tracks(window, motion);
  std::vector<Eigen::Matrix2Xd> points_px = window.points_px;
  for (int i = 0; i < window.frame_count(); ++i) {
    const Pose at_stamp = pose_after(motion, i, velocities[i], 0);
    for (int j = 0; j < window.track_count(); ++j) {
      if (!planes[j] || !points_px[i].col(j).allFinite()) continue;
      const Vector2d seen_px = points_px[i].col(j);
      const double seconds = row_delay_s * window.row_of(i, j);
      const Pose at_row = pose_after(motion, i, velocities[i], seconds);
      const auto point = intersect(*planes[j], at_row, K_inverse * seen_px.homogeneous());
      if (point) points_px[i].col(j) = (window.K * to_camera(at_stamp, *point)).hnormalized();
    }
  }
  return points_px;
}

RotationModel rotations_of(const Window& window, const Initialization& result) {
  return result.uncertainty ? result.uncertainty->rotations : window.rotations;
}

}  // namespace

Window without_rolling_shutter(const Window& window,
                               const PlaneMotion& motion,
                               std::span<const Velocity> velocities,
                               const RowDelayPrior& delay) {
  Window corrected = window;
  corrected.points_px = corrected_px(window, motion, velocities, delay.mean_s);
  corrected.row_delay_moves_px.clear();
  if (!(delay.sigma_s > 0)) return corrected;
  corrected.row_delay_moves_px =
      corrected_px(window, motion, velocities, delay.mean_s + delay.sigma_s);
  for (int i = 0; i < window.frame_count(); ++i)
    corrected.row_delay_moves_px[i] -= corrected.points_px[i];
  return corrected;
}

Window without_rolling_shutter(const Window& window,
                               const PlaneMotion& motion,
                               RotationModel rotations,
                               const RowDelayPrior& delay) {
  return without_rolling_shutter(window, motion, velocities_of(window, motion, rotations), delay);
}

Window without_lens_residual(Window window, const LensResidual& residual) {
  const Vector2d center_px = window.K.topRightCorner<2, 1>();
  for (Eigen::Matrix2Xd& points : window.points_px)
    for (auto point : points.colwise()) {
      const Vector2d seen_px = point - center_px;
      Vector2d p_px = seen_px;
      // The error changes by a hundredth of itself from one pixel to the other.
      for (int round = 0; round < 2; ++round) p_px = seen_px - residual.error_px(p_px);
      point = center_px + p_px;
    }
  return window;
}

Window as_seen_at_time_stamps(const Window& window, const Initialization& result) {
  if (!result.ok || !result.row_delay_s) return window;
  return without_rolling_shutter(
      window, motion_of(result), rotations_of(window, result), {*result.row_delay_s});
}

std::vector<RowMotion> row_motions(const Window& window, const Initialization& result) {
  std::vector<RowMotion> motions;
  for (const Velocity& one :
       velocities_of(window, motion_of(result), rotations_of(window, result))) {
    const Eigen::Matrix3d R_cw = result.cameras[motions.size()].R_wc.transpose();
    motions.push_back({one.rotation_rad_s,
                       one.rotation_rad_s2,
                       -result.plane.distance * R_cw * one.tau_s,
                       -result.plane.distance * R_cw * one.tau_s2});
  }
  return motions;
}

RowDelayPrior unknown_row_delay(const Window& window) {
  return {0, kReadoutSigma_s / window.row_count()};
}

std::vector<Velocity> velocities_of(const Window& window,
                                    const PlaneMotion& motion,
                                    RotationModel rotations) {
  return smooth_velocities(
      path_times(window.timestamps_ns), motion, path_noise(window, motion, rotations));
}

}  // namespace gpo
