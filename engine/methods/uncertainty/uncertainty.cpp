// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/uncertainty.h"

#include "engine/methods/plane/rolling_shutter.h"
#include "engine/methods/uncertainty/bend.h"
#include "engine/methods/uncertainty/information.h"
#include "engine/methods/uncertainty/shares.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

int tracks_of(const PlaneObservations& observations) {
  std::set<int> tracks;
  for (int k = 0; k < observations.plane_count(); ++k)
    for (const FrameObservations& f : observations.plane(k))
      tracks.insert(f.track.begin(), f.track.end());
  return static_cast<int>(tracks.size());
}

/// Returns the covariances of the main normal and the camera centers, and the variances of the
/// distance ratios 1 - n.tau.
NoiseSpread marginals(const PlaneMotion& motion, const Bread& bread, const Spread& spread) {
  const SharedMatrix& Y = spread.shared;
  NoiseSpread result{Y.topLeftCorner<2, 2>(), {Matrix3d::Zero()}, {0}};
  for (int i = 1; i < std::ssize(motion.tau); ++i) {
    const auto& gain = bread.frames[i].gain;
    const Eigen::MatrixXd cross = -Y * gain.transpose() + spread.cross[i];
    const Eigen::MatrixXd gained = gain * spread.cross[i];
    const Eigen::MatrixXd own =
        gain * Y * gain.transpose() - gained - gained.transpose() + spread.own[i];
    const Matrix3d t = own.bottomRightCorner<3, 3>();
    const Eigen::Matrix<double, 2, 3> ut = cross.topRightCorner<2, 3>();
    const Matrix3d& R = motion.R_wc[i];
    result.centers.emplace_back(R * t * R.transpose());
    const Eigen::Vector2d d_u = -(normal_tangents(motion.normal).transpose() * motion.tau[i]);
    const Vector3d d_t = -(R.transpose() * motion.normal);
    const double ratio_variance =
        d_u.dot(Y.topLeftCorner<2, 2>() * d_u) + 2 * d_u.dot(ut * d_t) + d_t.dot(t * d_t);
    result.distance_ratios.push_back(std::max(0.0, ratio_variance));
  }
  return result;
}

/// Returns the inverse information of the shared unknowns; zero for a held gyroscope.
std::optional<SharedMatrix> shared_inverse_of(const Bread& bread, bool holds_gyro) {
  const int size = bread.layout.size();
  const int unknown = holds_gyro ? bread.layout.of_gyro() : size;
  const auto inverse = inverse_information(bread.information.topLeftCorner(unknown, unknown));
  if (!inverse) return std::nullopt;
  SharedMatrix all = SharedMatrix::Zero(size, size);
  all.topLeftCorner(unknown, unknown) = *inverse;
  return all;
}

/// Returns the contribution of the prior of an estimated bias.
SharedMatrix prior_share(const Sandwich& sandwich, double sigma_px) {
  return sigma_px * sigma_px * sandwich.inverse * sandwich.bread.prior *
         sandwich.inverse.transpose();
}

/// Errors of a held gyroscope.
struct HeldGyro {
  Eigen::MatrixXd covariance;         ///< unknowns: bias, time offset
  std::optional<double> late_s = {};  ///< time offset by the tracks, if significant
};

/// Bias: its covariance is as stated, unless the second moment given the tracks contradicts its
/// size, which is then the moment's. Time offset: the moment (engine/method.md, eq. 15).
HeldGyro held_gyro(const SolvedPlanes& solved,
                   const Linearization& linearized,
                   double degrees_of_freedom) {
  const GyroSensitivity& gyro = *solved.window.gyro;
  const Matrix3d& stated = gyro.bias_covariance;
  const double variance = linearized.sigma_px * linearized.sigma_px;
  Bread bread = bread_of(solved, linearized, RotationModel::bias);
  const int at = bread.layout.of_gyro(), size = bread.layout.gyro;
  bread.information -= bread.prior;
  bread.prior.block<3, 3>(at, at) = variance * stated.inverse();
  bread.information += bread.prior;
  HeldGyro held{Eigen::MatrixXd::Zero(size, size)};
  held.covariance.topLeftCorner<3, 3>() = stated;
  if (size > 3) held.covariance(3, 3) = std::pow(gyro.time_offset_sigma_s, 2);
  const auto inverse = inverse_information(bread.information);
  if (!inverse) return held;
  const Sandwich sandwich{solved, bread, *inverse};
  const SharedMatrix covariance =
      spread_of(sandwich, influences_of(sandwich), degrees_of_freedom).shared +
      prior_share(sandwich, linearized.sigma_px);
  const Eigen::VectorXd step = -(*inverse * reduced_gradient(linearized, bread)).tail(size);
  const Eigen::MatrixXd moment = covariance.bottomRightCorner(size, size) + step * step.transpose();
  constexpr double kLeast = 0.038, kMost = 3.78;  // 1 and 99 % of chi-square of 3, by 3
  const double ratio = (stated.inverse() * moment.topLeftCorner<3, 3>()).trace() / 3;
  if (!(ratio > kLeast && ratio < kMost)) held.covariance.topLeftCorner<3, 3>() *= ratio;
  if (size < 4) return held;
  constexpr double kSignificantSigmas = 2.5;  // a late clock also widens the residuals
  held.covariance(3, 3) = moment(3, 3);
  const double sigma_s = std::sqrt(covariance.bottomRightCorner<1, 1>().value());
  if (std::abs(step(3)) > kSignificantSigmas * sigma_s) held.late_s = step(3);
  return held;
}

/// Adds the contribution of the errors db of a held gyroscope, which move the other unknowns by
/// -A_uu^-1 A_ub db.
void add_held_gyro(const Sandwich& sandwich,
                   const Linearization& linearized,
                   double degrees_of_freedom,
                   Spread& spread,
                   Uncertainty& result) {
  const HeldGyro held = held_gyro(sandwich.solved, linearized, degrees_of_freedom);
  const int size = sandwich.bread.layout.gyro;
  SharedMatrix moves = -sandwich.inverse * sandwich.bread.information.rightCols(size);
  moves.bottomRows(size).setIdentity();
  spread.shared += moves * held.covariance * moves.transpose();
  result.late_s = held.late_s;
  if (!held.late_s) return;
  const Eigen::Matrix<double, 2, 3> by_bias = moves.topLeftCorner<2, 3>();
  const auto of_bias = [&](const Matrix3d& covariance) {
    return (by_bias * covariance * by_bias.transpose()).trace();
  };
  const double stated = of_bias(sandwich.solved.window.gyro->bias_covariance);
  double by_clock = held.covariance(3, 3) * moves.col(3).head<2>().squaredNorm();
  // Such a clock is also why the tracks contradict the bias.
  if (by_clock > stated)
    by_clock += std::max(0.0, of_bias(held.covariance.topLeftCorner<3, 3>()) - stated);
  result.clock_sigma_deg = degrees(std::sqrt(by_clock));
}

void set_typical_lens(const Sandwich& sandwich, Errors errors, Uncertainty& result) {
  double variance = result.normal_covariance.trace();
  const auto moves = moves_by_lens(sandwich, typical_lens_moves_px(sandwich.solved.window));
  for (const SolutionMove& move : moves) variance += move.shared.head<2>().squaredNorm();
  result.typical_lens_sigma_deg = degrees(std::sqrt(variance));
  if (errors == Errors::all) result.typical_lens_moves.results = moves_of_results(sandwich, moves);
}

void add_plane_covariances(const PlaneMotion& motion,
                           const SharedMatrix& covariance,
                           Uncertainty& result) {
  const auto normal_covariance = [&](const Vector3d& normal, int plane) -> Matrix3d {
    const int at = UnknownsLayout::of_plane(plane);
    const auto N = normal_tangents(normal);
    return N * covariance.block<2, 2>(at, at) * N.transpose();
  };
  result.normal_covariance = normal_covariance(motion.normal, 0);
  result.normal_sigma_deg = degrees(std::sqrt(result.normal_covariance.trace()));
  for (int k = 1; k <= std::ssize(motion.others); ++k) {
    const int at = UnknownsLayout::of_plane(k) + 2;
    result.others.push_back({normal_covariance(motion.others[k - 1].m.normalized(), k),
                             std::sqrt(std::max(0.0, covariance(at, at)))});
  }
}

/// Adds the covariances of bias and time offset, if they are estimated.
void add_gyro(const UnknownsLayout& layout, const SharedMatrix& covariance, Uncertainty& result) {
  const int gyro = layout.of_gyro();
  if (result.rotations != RotationModel::bias) return;
  result.bias_covariance = covariance.block<3, 3>(gyro, gyro);
  if (layout.gyro > 3) result.time_offset_sigma_s = std::sqrt(covariance(gyro + 3, gyro + 3));
}

/// The row delay of points that a method takes as seen at once.
struct NeglectedRowDelay {
  double seconds = 0;
  std::vector<Eigen::Matrix2Xd> moves_px;  ///< by the root of its second moment
};

/// Returns the row delay of the camera or, if it is unknown and significant, by the tracks around
/// the solution. A held gyroscope's errors look alike.
std::optional<NeglectedRowDelay> neglected_row_delay(const SolvedPlanes& solved,
                                                     RotationModel model) {
  constexpr double kSignificantSigmas = 3;
  const auto& [window, observations, motion] = solved;
  const bool unknown = !window.row_delay;
  if (unknown && model == RotationModel::known && window.gyro) return std::nullopt;
  RowDelayPrior delay = window.row_delay.value_or(unknown_row_delay(window));
  const double size_s = std::hypot(delay.mean_s, delay.sigma_s);
  if (!(size_s > 0)) return std::nullopt;
  const RowDelayPrior of_moves{0, size_s};
  auto moves_px = without_rolling_shutter(window, motion, model, of_moves).row_delay_moves_px;
  if (unknown) {
    const auto by_tracks = multiple_of(solved, model, moves_px);
    if (!by_tracks || !(std::abs(by_tracks->value) > kSignificantSigmas * by_tracks->sigma))
      return std::nullopt;
    delay.mean_s = by_tracks->value * size_s;
    const double moment = std::hypot(by_tracks->value, by_tracks->sigma);
    for (Eigen::Matrix2Xd& move : moves_px) move *= moment;
  }
  return NeglectedRowDelay{delay.mean_s, std::move(moves_px)};
}

void add_bounds(const SolvedPlanes& solved, const Linearization& linearized, Uncertainty& result) {
  const auto bound_deg = [&](RotationModel of) {
    return normal_sigma_deg(bread_of(solved, linearized, of).information, linearized.sigma_px);
  };
  result.bound_known_rotations_deg = bound_deg(RotationModel::known);
  if (solved.window.gyro) result.bound_unknown_bias_deg = bound_deg(RotationModel::bias);
}

}  // namespace

std::optional<Uncertainty> uncertainty_of(const SolvedPlanes& solved,
                                          RotationModel model,
                                          Errors errors) {
  const auto& [window, observations, motion] = solved;
  const auto linearized = linearize(solved, model);
  if (!linearized) return std::nullopt;
  const double sigma_px = linearized->sigma_px;
  const bool holds_gyro = model == RotationModel::known && window.gyro;
  const Bread bread = bread_of(solved, *linearized, holds_gyro ? RotationModel::bias : model);
  const auto inverse = shared_inverse_of(bread, holds_gyro);
  if (!inverse) return std::nullopt;
  const Sandwich sandwich{solved, bread, *inverse};
  const double residuals = 2.0 * observations.count();
  const double unknowns = inverse->rows() + own_size(model, motion) * (solved.frame_count() - 1.0);
  const double degrees_of_freedom = residuals / std::max(1.0, residuals - unknowns);
  const Influences influences = influences_of(sandwich);
  Spread spread = spread_of(sandwich, influences, degrees_of_freedom);
  Uncertainty result;
  result.sigma_px = sigma_px;
  result.rotations = model;
  result.tracks = tracks_of(observations);
  result.noise = marginals(motion, bread, spread);
  const double without_lens = spread.shared.topLeftCorner<2, 2>().trace();
  std::vector<SolutionMove> moves_of_image = moves_by_lens(sandwich, window.lens_moves_px);
  for (const SolutionMove& move : moves_of_image) spread.add(move);
  const double of_lens = spread.shared.topLeftCorner<2, 2>().trace() - without_lens;
  if (!moves_of_image.empty()) result.lens_sigma_deg = degrees(std::sqrt(std::max(0.0, of_lens)));
  if (!window.row_delay_moves_px.empty()) {
    moves_of_image.push_back(moves_by_lens(sandwich, {&window.row_delay_moves_px, 1})[0]);
    spread.add(moves_of_image.back());
    result.shutter_sigma_deg = degrees(moves_of_image.back().shared.head<2>().norm());
  }
  add_gyro_noise(sandwich, spread);
  if (holds_gyro)
    add_held_gyro(sandwich, *linearized, degrees_of_freedom, spread, result);
  else
    spread.shared += prior_share(sandwich, sigma_px);
  add_plane_covariances(motion, spread.shared, result);
  if (window.lens_moves_px.empty()) set_typical_lens(sandwich, errors, result);
  NoiseSpread all = marginals(motion, bread, spread);
  result.center_covariances = std::move(all.centers);
  for (const double v : all.distance_ratios) result.distance_ratio_sigmas.push_back(std::sqrt(v));
  if (errors == Errors::all) {
    result.joint_covariance =
        joint_covariance(sandwich, influences, degrees_of_freedom, moves_of_image, spread.shared);
    result.joint_bias_rows = bread.layout.gyro;
  }
  add_gyro(bread.layout, spread.shared, result);
  // Errors of a held gyroscope look like a bend, and have their own share.
  if (errors == Errors::all && !holds_gyro)
    result.bend_sigma_deg = bend_sigma_deg(solved, sigma_px);
  add_bounds(solved, *linearized, result);
  return result;
}

std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const Plane& plane,
                                          std::span<const Pose> cameras,
                                          RotationModel model) {
  const PlaneMotion motion = motion_of(plane, cameras);
  const PlaneObservations observations = plane_observations(window);
  const auto row_delay = neglected_row_delay({window, observations, motion}, model);
  if (!row_delay) return uncertainty_of({window, observations, motion}, model);
  Window late = window;
  late.row_delay_moves_px = row_delay->moves_px;
  auto result = uncertainty_of({late, observations, motion}, model);
  if (result) result->neglected_row_delay_s = row_delay->seconds;
  return result;
}

void add_typical_lens(Initialization& result) {
  if (!result.uncertainty || result.uncertainty->typical_lens_moves.results.size() == 0) return;
  Uncertainty& u = *result.uncertainty;
  const auto& [results, poses, row_delay_s] = u.typical_lens_moves;
  const Eigen::MatrixXd change = square_of(results);
  add_to_marginals(motion_of(result.plane, result.cameras), change, u);
  if (u.joint_covariance.size() > 0) u.joint_covariance += change;
  if (u.pose_covariance.size() > 0) u.pose_covariance += square_of(poses);
  if (u.row_delay_sigma_s)
    u.row_delay_sigma_s = std::hypot(*u.row_delay_sigma_s, row_delay_s.norm());
  const auto planes_at = change.rows() - 3 * std::ssize(u.others) - 2;
  for (std::size_t k = 0; k < result.planes.size() && k <= u.others.size(); ++k) {
    PlaneEstimate& plane = result.planes[k];
    const auto N = normal_tangents(plane.plane.normal);
    const auto at = planes_at + UnknownsLayout::of_plane(static_cast<int>(k));
    const Matrix3d by_lens = N * change.block<2, 2>(at, at) * N.transpose();
    if (k > 0) u.others[k - 1].normal_covariance += by_lens;
    if (plane.normal_covariance) *plane.normal_covariance += by_lens;
    if (k > 0) plane.distance_sigma = u.others[k - 1].log_distance_sigma * plane.plane.distance;
  }
  u.includes_typical_lens = true;
}

}  // namespace gpo
