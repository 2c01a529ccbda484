// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/sensors_rest.h"

#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/window/gyroscope_rest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/QR>

namespace gpo {
namespace {

using Eigen::Vector3d;

// Measured on a poster that moves before a camera at rest (16 real images and 12 simulated motions,
// 10, 16 and 30 frames each), and on simulated cameras that move or turn evenly, so that their
// sensors are at rest, too. No window of euroc-room, cards-tracks, tags-straight, tags-mountain,
// phone-street or a GoPro's video has sensors at rest.
constexpr double kLeastMotion_px = 5;  // least motion of the plane's tracks
constexpr int kLeastStill = 10;        // posters: 35 to 62, others 0
constexpr double kLeastStillShare = 0.05;
constexpr double kLeastTilt_deg = 1.5;    // posters: 1.3 to 16, others up to 0.6
constexpr double kLeastTurn_deg = 1;      // posters: 0.5 to 17, others 0
constexpr double kLeastDistance_m = 0.1;  // no plane is filmed from less

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

/// Returns the median over the plane's tracks of their largest distance from where they are in the
/// first frame [px]; 0 without any.
double motion_of_plane_px(const Window& window) {
  std::vector<double> most_px;
  for (int k = 0; k < window.track_count(); ++k) {
    if (!window.is_inlier_track(k)) continue;
    double& most = most_px.emplace_back(0);
    for (const Eigen::Matrix2Xd& points : window.points_px)
      most = std::fmax(most, (points.col(k) - window.points_px.front().col(k)).norm());
  }
  return most_px.empty() ? 0 : median(std::move(most_px));
}

std::vector<Pose> cameras_of(const Initialization& result) {
  if (result.ok) return result.cameras;
  return result.refused ? result.refused->cameras : std::vector<Pose>{};
}

/// Root mean square distance of the path from a motion of constant acceleration [plane distance].
double uneven_path(const Window& window, const std::vector<Pose>& cameras) {
  const auto count = static_cast<Eigen::Index>(cameras.size());
  Eigen::MatrixX3d powers(count, 3), path(count, 3);
  const double whole_s = seconds(window.timestamps_ns.back() - window.timestamps_ns.front());
  for (Eigen::Index i = 0; i < count; ++i) {
    const double t = seconds(window.timestamps_ns[i] - window.timestamps_ns.front()) / whole_s;
    powers.row(i) << 1, t, t * t;
    path.row(i) = cameras[i].p_wc.transpose();
  }
  const Eigen::MatrixX3d left = path - powers * powers.householderQr().solve(path);
  return std::sqrt(left.squaredNorm() / static_cast<double>(count));
}

/// Returns the largest distance of the plane at which the path has no accelerations above
/// `most_m_s2`, for motions of one period in the window.
double most_distance_m(const Window& window, const std::vector<Pose>& cameras, double most_m_s2) {
  constexpr double kLeastUneven = 0.005;  // smaller ones are noise of the poses
  const double uneven = uneven_path(window, cameras);
  if (!(uneven > kLeastUneven)) return std::numeric_limits<double>::infinity();
  const double period = seconds(window.timestamps_ns.back() - window.timestamps_ns.front());
  return most_m_s2 * std::pow(period / (2 * M_PI), 2) / uneven;
}

/// Adds the rotations of the result that the sensors do not measure.
void add_rotations(const Window& window,
                   const Gyroscope& gyroscope,
                   const SensorsAtRest& rest,
                   const std::vector<Pose>& cameras,
                   SensorsRest& found) {
  constexpr double kUpError = 0.03;  // share of a rotation: an accelerometer's bias of 0.3 m/s^2
  const Eigen::Matrix3d R_cg = gyroscope.R_gyro_camera.transpose();
  for (std::size_t i = 1; i < cameras.size(); ++i) {
    const Eigen::Matrix3d& R = cameras[i].R_wc;
    const double time_s = seconds(window.timestamps_ns[i] - window.timestamps_ns.front());
    const Vector3d by_sensor = R_cg * (rest.mean_rad_s - gyroscope.bias_rad_s) * time_s;
    const double unexplained = so3_log(so3_exp(by_sensor).transpose() * R).norm() -
                               kMostBiasSigmas * gyroscope.bias_sigma_rad_s * time_s;
    found.turned_deg = std::max(found.turned_deg, degrees(unexplained));
    if (!rest.mean_m_s2) continue;
    const Vector3d up = (R_cg * *rest.mean_m_s2).normalized();
    const double tilt = std::atan2(up.cross(R * up).norm(), up.dot(R * up));
    found.tilted_deg = std::max(found.tilted_deg, degrees(tilt - kUpError * so3_log(R).norm()));
  }
}

}  // namespace

bool SensorsRest::is_tilted() const { return tilted_deg > kLeastTilt_deg + uncertain_deg; }

bool SensorsRest::is_too_close() const { return most_m < kLeastDistance_m; }

bool SensorsRest::is_turned() const { return turned_deg > kLeastTurn_deg + uncertain_deg; }

bool SensorsRest::camera_rests() const {
  return accelerometer && (!still_tracks.empty() || is_tilted() || is_too_close());
}

std::optional<SensorsRest> sensors_rest(const Window& window,
                                        const Gyroscope& gyroscope,
                                        const Initialization& result) {
  constexpr double kSigmas = 3, kUnknownSigma_deg = 1;
  const auto& times_ns = window.timestamps_ns;
  const std::size_t begin = first_after(gyroscope, times_ns.front() + gyroscope.time_offset_ns - 1);
  const std::size_t end = first_after(gyroscope, times_ns.back() + gyroscope.time_offset_ns);
  const auto rest = sensors_at_rest(gyroscope, begin, end);
  if (!rest) return std::nullopt;
  SensorsRest found{.accelerometer = rest->mean_m_s2.has_value()};
  found.moved_px = motion_of_plane_px(window);
  if (found.moved_px < kLeastMotion_px) return std::nullopt;
  const auto still = std::ssize(window.static_tracks);
  if (still >= kLeastStill && static_cast<double>(still) >= kLeastStillShare * window.track_count())
    found.still_tracks = window.static_tracks;
  const std::vector<Pose> cameras = cameras_of(result);
  if (cameras.size() != times_ns.size()) return found;
  found.uncertain_deg =
      kSigmas * (result.uncertainty ? result.uncertainty->normal_sigma_deg : kUnknownSigma_deg);
  add_rotations(window, gyroscope, *rest, cameras, found);
  if (rest->mean_m_s2) found.most_m = most_distance_m(window, cameras, rest->most_m_s2);
  return found;
}

}  // namespace gpo
