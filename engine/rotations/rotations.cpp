// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/rotations/rotations.h"

#include "engine/base/error.h"
#include "engine/geometry/homography.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastSigma_rad = 0.001;  // for visual rotations, because tracks drift

std::vector<Vector3d> residuals_rad(Gyroscope& gyroscope,
                                    const Vector3d& bias_rad_s,
                                    std::span<const std::int64_t> frame_times_ns,
                                    std::span<const Matrix3d> R_wc_visual) {
  gyroscope.bias_rad_s = bias_rad_s;
  const std::vector<Matrix3d> R_wc = gyro_rotations(gyroscope, frame_times_ns);
  std::vector<Vector3d> residuals;
  for (std::size_t i = 1; i < R_wc.size(); ++i)
    residuals.push_back(so3_log(R_wc[i].transpose() * R_wc_visual[i]));
  return residuals;
}

/// Least share of tracks off the plane that fit the epipolar geometry. In nine windows of a room it
/// was 34 % or more, in nine of a board on a floor up to 10 % (relief and lens).
constexpr double kLeastOffPlaneShare = 0.15;
constexpr int kLeastOffPlane = 10;
constexpr double kLeastConsistent = 0.5;  // share of the tracks off the plane; fewer are outliers
constexpr double kSeenByFrames = 0.5;     // share of frames, the best ones: parallax grows

/// The window's tracks, sorted by position so that their order in the window does not matter.
struct WindowRays {
  std::vector<int> tracks;             // indices in the window
  std::vector<int> group;              // plane of each of `tracks`, or the last: none
  std::vector<Eigen::Matrix3Xd> rays;  // one per frame, NaN: not seen
  // Distances from the plane, one per frame; NaN: unknown; infinite: there is no plane.
  std::vector<Eigen::ArrayXd> miss_px;
};

std::vector<int> groups_of(const Window& window) {
  const int count = window.track_count();
  std::vector<int> group(count, std::max(1, static_cast<int>(window.planes.size())));
  for (std::size_t p = 0; p < window.planes.size(); ++p)
    for (const int k : window.planes[p].tracks) group[k] = static_cast<int>(p);
  if (!window.planes.empty()) return group;
  for (int k = 0; k < count; ++k)
    if (window.is_inlier_track(k)) group[k] = 0;
  return group;
}

WindowRays rays_of(const Window& window) {
  WindowRays result;
  const Eigen::Matrix2Xd& first = window.points_px.front();
  for (int k = 0; k < window.track_count(); ++k)
    if (first.col(k).allFinite()) result.tracks.push_back(k);
  std::ranges::sort(result.tracks, {}, [&](int k) { return std::pair(first(0, k), first(1, k)); });
  const std::vector<int> group = groups_of(window);
  for (const int k : result.tracks) result.group.push_back(group[k]);
  const Matrix3d K_inverse = window.K.inverse();
  const auto& H_i1 = window.planes.empty() ? window.H_i1 : window.planes.front().H_i1;
  const bool plane = std::any_of(
      std::next(H_i1.begin()), H_i1.end(), [](const Matrix3d& H) { return H.allFinite(); });
  for (int i = 0; i < window.frame_count(); ++i) {
    const Eigen::Matrix2Xd seen = window.points_px[i](Eigen::all, result.tracks);
    result.rays.emplace_back(K_inverse * seen.colwise().homogeneous());
    Eigen::ArrayXd miss_px(seen.cols());
    for (Eigen::Index k = 0; k < seen.cols(); ++k) {
      miss_px[k] = (transfer(H_i1[i], first.col(result.tracks[k])) - seen.col(k)).norm();
      if (!plane && seen.col(k).allFinite()) miss_px[k] = std::numeric_limits<double>::infinity();
    }
    result.miss_px.push_back(std::move(miss_px));
  }
  return result;
}

struct JoinedPair {
  std::vector<int> common;  // tracks that both frames see, indices into WindowRays
  RelativePose pose;
};

std::optional<JoinedPair> joined(const WindowRays& window,
                                 int i,
                                 int j,
                                 const std::vector<bool>& usable,
                                 RelativePoseOptions options) {
  JoinedPair pair;
  RayPairs rays;
  for (Eigen::Index k = 0; k < window.rays[i].cols(); ++k) {
    if (!usable[k] || !window.rays[i].col(k).allFinite() || !window.rays[j].col(k).allFinite())
      continue;
    pair.common.push_back(static_cast<int>(k));
    rays.group.push_back(window.group[k]);
  }
  rays.i = window.rays[i](Eigen::all, pair.common);
  rays.j = window.rays[j](Eigen::all, pair.common);
  options.seed += 1'000'003ULL * static_cast<std::uint64_t>(i) + static_cast<std::uint64_t>(j);
  auto pose = relative_pose(rays, options);
  if (!pose) return std::nullopt;
  pair.pose = std::move(*pose);
  return pair;
}

double typical_share(std::vector<double> shares) {
  std::ranges::sort(shares);
  return quantile(shares, 1 - kSeenByFrames);
}

double off_plane_share(const WindowRays& rays, double threshold_px) {
  std::vector<double> shares;
  for (std::size_t j = 1; j < rays.rays.size(); ++j) {
    int seen = 0, off = 0;
    for (const double miss : rays.miss_px[j]) {
      seen += std::isnan(miss) ? 0 : 1;
      off += miss > threshold_px ? 1 : 0;
    }
    shares.push_back(static_cast<double>(off) / std::max(seen, 1));
  }
  return typical_share(std::move(shares));
}

double structure_share(const WindowRays& rays,
                       const std::vector<JoinedPair>& reference_pairs,
                       double threshold_px) {
  std::vector<double> shares;
  for (std::size_t j = 1; j < rays.rays.size(); ++j) {
    const JoinedPair& pair = reference_pairs[j - 1];
    int off = 0, consistent = 0;
    for (std::size_t k = 0; k < pair.common.size(); ++k) {
      if (!(rays.miss_px[j][pair.common[k]] > threshold_px)) continue;
      ++off;
      consistent += pair.pose.inlier[k] ? 1 : 0;
    }
    const bool structure = consistent >= kLeastOffPlane && consistent > kLeastConsistent * off;
    shares.push_back(structure ? static_cast<double>(consistent) / pair.common.size() : 0);
  }
  return typical_share(std::move(shares));
}

Rotations ambiguous_on_plane(const char* name) {
  return {{}, fmt::format("{} rotations: ambiguous, nearly all tracks lie on one plane", name)};
}

std::vector<bool> trusted(const WindowRays& rays, const std::vector<JoinedPair>& pairs) {
  std::vector<int> votes(rays.tracks.size(), 0);
  for (const JoinedPair& pair : pairs)
    for (std::size_t k = 0; k < pair.common.size(); ++k)
      votes[pair.common[k]] += pair.pose.inlier[k] ? 1 : -1;
  std::vector<bool> usable;
  for (const int vote : votes) usable.push_back(vote >= 0);
  return usable;
}

double disagreement_rad(const std::vector<RelativeRotation>& relative,
                        const std::vector<Matrix3d>& R_wc) {
  std::vector<double> angles;
  for (const auto& [i, j, R_ij, weight] : relative)
    angles.push_back(so3_log(R_wc[i] * R_ij * R_wc[j].transpose()).norm());
  return median(std::move(angles));
}

}  // namespace

bool needs_gyroscope(RotationSource source) {
  return source == RotationSource::gyro || source == RotationSource::gyro_calibrated;
}

Rotations sensitive_gyro_rotations(const Gyroscope& gyroscope,
                                   std::span<const std::int64_t> frame_times_ns) {
  std::vector<std::int64_t> times_ns(frame_times_ns.begin(), frame_times_ns.end());
  for (std::int64_t& t : times_ns) t += gyroscope.time_offset_ns;
  const std::string reason = why_not_covered(gyroscope, times_ns.front(), times_ns.back());
  if (!reason.empty()) throw InputError(reason);
  const Matrix3d R_cg = gyroscope.R_gyro_camera.transpose();
  const auto rate = [&](std::int64_t t_ns) -> Vector3d {
    return sample_at(gyroscope, t_ns).rate_rad_s - gyroscope.bias_rad_s;
  };
  const auto acceleration = [&](std::int64_t t_ns) -> Vector3d {  // [rad/s^2]
    constexpr std::int64_t kHalf_ns = 10'000'000;
    const std::int64_t from_ns = std::max(t_ns - kHalf_ns, gyroscope.timestamps_ns.front());
    const std::int64_t to_ns = std::min(t_ns + kHalf_ns, gyroscope.timestamps_ns.back());
    if (to_ns <= from_ns) return Vector3d::Zero();  // beyond the samples the rate is constant
    return (rate(to_ns) - rate(from_ns)) / (1e-9 * static_cast<double>(to_ns - from_ns));
  };
  const Vector3d first_rate = rate(times_ns.front());
  const Vector3d first_acceleration = acceleration(times_ns.front());
  Rotations rotations{.model = RotationModel::bias};
  const double held_rad_s = held_bias_sigma_rad_s(gyroscope);
  GyroSensitivity gyro{.bias_rad_s = gyroscope.bias_rad_s,
                       .prior_rad_s = gyroscope.bias_rad_s,
                       .prior_sigma_rad_s = gyroscope.bias_sigma_rad_s,
                       .bias_covariance = held_rad_s * held_rad_s * Matrix3d::Identity(),
                       .time_offset_s = 1e-9 * static_cast<double>(gyroscope.time_offset_ns),
                       .time_offset_sigma_s = kTimeOffsetSigma_s,
                       .noise_density = gyroscope.noise_density,
                       .d_bias = {},
                       .d_offset = {},
                       .d2_offset = {}};
  // Rotation since the first frame: R_first_now(bias + db) ~ R_first_now exp(d_bias db).
  Matrix3d R_first_now = Matrix3d::Identity(), d_bias = Matrix3d::Zero();
  // Forster et al., "On-Manifold Preintegration", eq. 44 with its sum as a recursion.
  const auto advance = [&](const InertialSample& mean, double dt_s) {
    const Vector3d step = (mean.rate_rad_s - gyroscope.bias_rad_s) * dt_s;
    const Matrix3d R_step = so3_exp(step);
    R_first_now = R_first_now * R_step;
    d_bias = R_step.transpose() * d_bias - so3_right_jacobian(step) * dt_s;
  };
  for (std::size_t i = 0; i < times_ns.size(); ++i) {
    if (i > 0) integrate(gyroscope, times_ns[i - 1], times_ns[i], advance);
    rotations.R_wc.push_back(R_cg * R_first_now * R_cg.transpose());
    gyro.d_bias.push_back(R_cg * d_bias);
    // A later clock drops the rotation at the first frame and adds that at the last one:
    // exp(-w_1 dt) R exp(w_i dt) = R exp((w_i - R^T w_1) dt), all in the gyroscope's axes; to
    // second order w dt + w' dt^2 / 2 takes the place of w dt, and half of the commutator is added.
    const Vector3d now = rate(times_ns[i]);
    const Matrix3d R_now_first = R_first_now.transpose();
    gyro.d_offset.push_back(R_cg * (now - R_now_first * first_rate));
    gyro.d2_offset.push_back(R_cg * (acceleration(times_ns[i]) - R_now_first * first_acceleration -
                                     (R_now_first * first_rate).cross(now)));
  }
  rotations.gyro = std::move(gyro);
  return rotations;
}

std::vector<Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                     std::span<const std::int64_t> frame_times_ns) {
  return sensitive_gyro_rotations(gyroscope, frame_times_ns).R_wc;
}

GyroBias fit_gyro_bias(const Gyroscope& given,
                       std::span<const std::int64_t> frame_times_ns,
                       const Rotations& visual) {
  constexpr double kStep_rad_s = 1e-4;  // the rotations are almost linear in the bias
  const double sigma_rad = std::max(visual.sigma_rad, kLeastSigma_rad);
  Gyroscope gyroscope = given;
  Vector3d bias = given.bias_rad_s;
  Matrix3d covariance;
  for (int round = 0; round < 20; ++round) {
    const auto residuals = residuals_rad(gyroscope, bias, frame_times_ns, visual.R_wc);
    std::vector<Matrix3d> J(residuals.size());
    for (int k = 0; k < 3; ++k) {
      const Vector3d step = kStep_rad_s * Vector3d::Unit(k);
      const auto moved = residuals_rad(gyroscope, bias + step, frame_times_ns, visual.R_wc);
      for (std::size_t i = 0; i < J.size(); ++i)
        J[i].col(k) = (moved[i] - residuals[i]) / kStep_rad_s;
    }
    const double prior = 1 / (given.bias_sigma_rad_s * given.bias_sigma_rad_s);
    Matrix3d JtJ = prior * Matrix3d::Identity();
    Vector3d Jtr = prior * (bias - given.bias_rad_s);
    for (std::size_t i = 0; i < J.size(); ++i) {
      const double huber = huber_weight(residuals[i].norm(), sigma_rad);
      const double weight = huber / (sigma_rad * sigma_rad * static_cast<double>(residuals.size()));
      JtJ += weight * J[i].transpose() * J[i];
      Jtr += weight * J[i].transpose() * residuals[i];
    }
    covariance = JtJ.inverse();
    const Vector3d step = -covariance * Jtr;
    bias += step;
    if (step.norm() < 1e-9) break;
  }
  return {bias, covariance};
}

Rotations calibrated_gyro_rotations(const Gyroscope& gyroscope,
                                    const Window& window,
                                    const std::stop_token& stop) {
  const std::vector<Matrix3d> R_wc_given = gyro_rotations(gyroscope, window.timestamps_ns);
  Rotations visual = averaged_rotations(window, stop, R_wc_given);
  if (visual.R_wc.empty()) return visual;
  Gyroscope calibrated = gyroscope;
  const GyroBias fitted = fit_gyro_bias(gyroscope, window.timestamps_ns, visual);
  calibrated.bias_rad_s = fitted.bias_rad_s;
  Rotations rotations = sensitive_gyro_rotations(calibrated, window.timestamps_ns);
  rotations.gyro->prior_rad_s = gyroscope.bias_rad_s;
  rotations.gyro->bias_covariance = fitted.covariance;
  rotations.R_wc_images = std::move(visual.R_wc);
  rotations.sigma_rad = visual.sigma_rad;
  return rotations;
}

Rotations pair_rotations(const Window& window,
                         const PairRotationOptions& options,
                         const std::stop_token& stop) {
  const char* name = options.solver == RelativeSolver::five_point ? "five-point" : "direct";
  const WindowRays rays = rays_of(window);
  if (off_plane_share(rays, options.threshold_px) < kLeastOffPlaneShare)
    return ambiguous_on_plane(name);
  RelativePoseOptions of_pair{.solver = options.solver,
                              .gate = options.threshold_px / window.K(0, 0),
                              .seed = options.seed};
  const std::vector<bool> all(rays.tracks.size(), true);
  std::vector<JoinedPair> reference_pairs;
  std::vector<RelativeRotation> relative;
  std::vector<Matrix3d> R_wc{Matrix3d::Identity()};
  const auto add = [&](int i, int j, const RelativePose& pose) {
    relative.push_back(
        {.i = i, .j = j, .R_ij = pose.R_ij, .weight = static_cast<double>(pose.inliers)});
  };
  for (int j = 1; j < window.frame_count(); ++j) {
    if (stop.stop_requested()) return {.reason = "stopped", .stopped = true};
    of_pair.R_ij_guess = R_wc.back();
    auto pair = joined(rays, 0, j, all, of_pair);
    if (!pair)
      return {{},
              fmt::format("{} rotations: too few tracks join frame {} to the reference frame "
                          "(at least {})",
                          name,
                          window.start + j,
                          kLeastPairRays)};
    add(0, j, pair->pose);
    R_wc.push_back(pair->pose.R_ij);
    reference_pairs.push_back(std::move(*pair));
  }
  if (structure_share(rays, reference_pairs, options.threshold_px) < kLeastOffPlaneShare)
    return ambiguous_on_plane(name);
  const std::vector<bool> usable = trusted(rays, reference_pairs);
  for (int i = 1; i < window.frame_count(); ++i) {
    if (stop.stop_requested()) return {.reason = "stopped", .stopped = true};
    for (const int length : kPairLengths) {
      const int j = i + length;
      if (j >= window.frame_count()) break;
      of_pair.R_ij_guess = R_wc[i].transpose() * R_wc[j];
      if (const auto pair = joined(rays, i, j, usable, of_pair)) add(i, j, pair->pose);
    }
  }
  R_wc = average_rotations(relative, std::move(R_wc));
  const double sigma_rad = disagreement_rad(relative, R_wc);
  return {.R_wc = std::move(R_wc), .model = RotationModel::free, .sigma_rad = sigma_rad};
}

}  // namespace gpo
