// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/rolling_shutter.h"

#include "engine/geometry/pose.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Camera velocity at the time of a frame.
struct FrameVelocity {
  Vector3d rotation_rad_s;  ///< in the camera axes
  Vector3d tau_s;           ///< dtau/dt [plane distances / s]
};

/// Returns the slope of the parabola through three frames; at the ends of the line through two.
FrameVelocity velocity_at(const Window& window, const PlaneMotion& motion, int frame) {
  const int before = std::max(0, frame - 1);
  const int after = std::min(window.frame_count() - 1, frame + 1);
  const double seconds =
      1e-9 * static_cast<double>(window.timestamps_ns[after] - window.timestamps_ns[before]);
  return {so3_log(motion.R_wc[before].transpose() * motion.R_wc[after]) / seconds,
          (motion.tau[after] - motion.tau[before]) / seconds};
}

Pose pose_after(const PlaneMotion& motion,
                int frame,
                const FrameVelocity& velocity,
                double seconds) {
  return {motion.R_wc[frame] * so3_exp(seconds * velocity.rotation_rad_s),
          -(motion.tau[frame] + seconds * velocity.tau_s)};
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

}  // namespace

Window without_rolling_shutter(const Window& window,
                               const PlaneMotion& motion,
                               double row_delay_s) {
  Window corrected = window;
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  const auto planes = planes_of_tracks(window, motion);
  for (int i = 0; i < window.frame_count(); ++i) {
    const FrameVelocity velocity = velocity_at(window, motion, i);
    const Pose at_stamp = pose_after(motion, i, velocity, 0);
    for (int j = 0; j < window.track_count(); ++j) {
      if (!planes[j] || !window.points_px[i].col(j).allFinite()) continue;
      const Vector2d& seen_px = window.points_px[i].col(j);
      const double seconds = row_delay_s * (seen_px.y() - window.K(1, 2));
      const auto point = intersect(
          *planes[j], pose_after(motion, i, velocity, seconds), K_inverse * seen_px.homogeneous());
      if (!point) continue;
      corrected.points_px[i].col(j) = (window.K * to_camera(at_stamp, *point)).hnormalized();
    }
  }
  return corrected;
}

}  // namespace gpo
