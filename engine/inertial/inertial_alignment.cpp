// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inertial/inertial_alignment.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/plane.h"
#include "engine/inertial/alignment_problem.h"
#include "engine/inertial/preintegration.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kLeastFrames = 5;
constexpr double kLeastForce_m_s2 = 5;  // mean specific force; less is free fall or in g
constexpr double kMostForce_m_s2 = 20;
constexpr double kMostMisfit = 100;  // ten standard deviations: other axes or clock

InertialAlignment refused(std::string reason) { return {.reason = std::move(reason)}; }

/// The gyroscope's bias for which its rotations agree with those of the poses.
struct BiasFit {
  Vector3d bias_rad_s;
  Matrix3d covariance;
};

/// One round of least squares over log((R_wc)^T R_gyro) = D db, sensor axes.
BiasFit fit_bias(const UncertainPoses& poses,
                 std::span<const Preintegration> between,
                 const Matrix3d& R_sensor_camera,
                 const Vector3d& bias_rad_s) {
  constexpr double kAlike = 5;  // number of neighbors with similar errors
  const auto path = inertial_path(between, R_sensor_camera.transpose());
  Matrix3d N = 1e-12 * Matrix3d::Identity();
  Vector3d b = Vector3d::Zero();
  double squares = 0;
  for (std::size_t k = 1; k < path.size(); ++k) {
    const Matrix3d R_w_sensor = poses.cameras[k].R_wc * R_sensor_camera.transpose();
    const Vector3d error = so3_log(R_w_sensor * path[k].R.transpose());
    const Matrix3d D = path[k].by_biases.topLeftCorner<3, 3>();
    N += D.transpose() * D;
    b += D.transpose() * error;
    squares += error.squaredNorm();
  }
  const Vector3d step = solve_symmetric(N, b);
  const double left = std::max(0.0, squares - step.dot(b));
  const double freedom = std::max(1.0, 3.0 * static_cast<double>(path.size()) - 6);
  return {bias_rad_s + step, kAlike * left / freedom * N.inverse()};
}

/// Number of residuals minus unknowns without a prior.
double freedom_of(const AlignmentProblem& problem) {
  return static_cast<double>(problem.centers.size()) - 6;
}

/// Expected part of the log scale's information that is due to noise: the errors of the smoothed
/// path, V = S - C Sigma^-1 C^T, look like motion. With
/// Sigma = L L^T, K = L^-1 C^T L^-T and C^T = S + B P^T,
///   L^-1 V L^-T = K - (L^-1 B) (L^-1 P)^T - K^T K.
double information_of_noise(const ResidualNoise& noise, const MatrixXd& other_columns) {
  const auto L = noise.covariance.matrixL();
  MatrixXd K = noise.with_path;
  L.solveInPlace(K);
  K.transposeInPlace();
  L.solveInPlace(K);
  const MatrixXd b = L.solve(noise.by_bias);
  const MatrixXd p = L.solve(noise.with_bias);
  const MatrixXd K_others = K * other_columns;
  MatrixXd inside = other_columns.transpose() * K_others;
  inside.noalias() -= (other_columns.transpose() * b) * (p.transpose() * other_columns);
  inside.noalias() -= K_others.transpose() * K_others;
  const MatrixXd squares = other_columns.transpose() * other_columns;
  return K.trace() - b.cwiseProduct(p).sum() - K.squaredNorm() -
         solve_symmetric(squares, inside).trace();
}

MatrixXd prior_of(const AlignmentProblem& problem) {
  constexpr double kHardlyAny = 1e-6;  // keeps it invertible without motion
  MatrixXd prior = MatrixXd::Zero(kAlignmentUnknowns, kAlignmentUnknowns);
  prior(kScaleUnknown, kScaleUnknown) = kHardlyAny;
  prior.diagonal().segment<3>(6).setConstant(std::pow(problem.bias_sigma_m_s2, -2));
  prior.diagonal().segment<3>(9).setConstant(std::pow(problem.lever_sigma_m, -2));
  return prior;
}

/// Residuals and their derivatives in units of their noise.
struct WhiteResiduals {
  VectorXd r;
  MatrixXd J;
};

/// The derivative by the scale has the smoothed path (total least squares), since the noisy one
/// makes the scale too small.
WhiteResiduals white_residuals(const AlignmentProblem& problem,
                               const AlignmentState& state,
                               const ResidualNoise& noise) {
  const auto L = noise.covariance.matrixL();
  VectorXd r = L.solve(residuals(problem, state));
  const VectorXd path =
      std::exp(state.log_scale) * problem.centers - noise.with_path * L.transpose().solve(r);
  return {std::move(r), L.solve(jacobian(problem, state, path))};
}

struct Refinement {
  AlignmentState state;
  MatrixXd information;
  MatrixXd white;  ///< Jacobian in units of the residuals' noise
  std::optional<ResidualNoise> noise;
  double cost = 0;  ///< squared residuals, priors among them
  int iterations = 0;
};

/// Gauss-Newton; only the scale is not linear.
Refinement refine(const AlignmentProblem& problem, AlignmentState state) {
  constexpr int kMostIterations = 12;
  constexpr double kConverged = 1e-2;  // step in standard deviations
  constexpr double kSameScale = 5e-3;  // change of log s that leaves the noise as it is
  const MatrixXd prior = prior_of(problem);
  Refinement result;
  for (; result.iterations < kMostIterations; ++result.iterations) {
    if (!result.noise || std::abs(state.log_scale - result.noise->log_scale) > kSameScale)
      result.noise = residual_noise(problem, state);
    if (!result.noise) return result;
    auto [white_r, white] = white_residuals(problem, state, *result.noise);
    result.white = std::move(white);
    result.information = prior;
    result.information.noalias() += result.white.transpose() * result.white;
    VectorXd off = VectorXd::Zero(kAlignmentUnknowns);
    off.segment<3>(6) = state.bias;
    off.segment<3>(9) = state.lever - problem.lever_m;
    result.cost = white_r.squaredNorm() + off.dot(prior * off);
    const VectorXd gradient = result.white.transpose() * white_r + prior * off;
    VectorXd step = -solve_symmetric(result.information, gradient);
    const double converged = step.dot(result.information * step);
    step(kScaleUnknown) = std::clamp(step(kScaleUnknown), -1.0, 1.0);
    state = stepped(state, step);
    result.state = state;
    if (converged < kConverged * kConverged) break;
  }
  return result;
}

/// Computes standard deviations from the information, minus the part of the scale's that is noise.
void add_certainty(const Refinement& refined,
                   const InertialOptions& options,
                   InertialAlignment& result) {
  const MatrixXd rough = inverse_of_symmetric(refined.information);
  MatrixXd others(refined.white.rows(), kAlignmentUnknowns - 1);
  others << refined.white.leftCols<kScaleUnknown>(),
      refined.white.rightCols<kAlignmentUnknowns - 1 - kScaleUnknown>();
  const double by_all = 1 / rough(kScaleUnknown, kScaleUnknown);
  // At most a quarter of an observation's information is noise, which is negligible beside much.
  constexpr double kNegligible = 100;
  const double most_by_noise = 0.25 * static_cast<double>(refined.white.rows());
  const double by_noise =
      by_all < kNegligible * most_by_noise ? information_of_noise(*refined.noise, others) : 0;
  const double by_motion = by_all - by_noise;
  const double scatter = 2 * std::sqrt(0.5 * std::max(0.0, by_noise));
  const double spread = std::max(1.0, result.misfit);
  const MatrixXd covariance = spread * rough;
  const auto tangents = normal_tangents(refined.state.gravity.normalized());
  result.direction_covariance = tangents * covariance.block<2, 2>(3, 3) * tangents.transpose();
  result.accelerometer_bias_covariance = covariance.block<3, 3>(6, 6);
  result.log_scale_sigma =
      by_motion > 0 ? std::sqrt(spread / by_motion) : std::numeric_limits<double>::infinity();
  const double surely = by_motion - scatter;
  result.scale_known = surely > 0 && std::sqrt(spread / surely) < options.most_scale_sigma;
  if (!result.scale_known) result.scale_reason = "not determined: change speed or direction";
}

/// Adds the effects of errors that residuals hardly show, by how they move the solution. The scale
/// has at least their own size.
void add_moves(const Refinement& refined,
               std::span<const VectorXd> changes,
               const InertialOptions& options,
               InertialAlignment& result) {
  const MatrixXd gain = inverse_of_symmetric(refined.information) * refined.white.transpose();
  const auto tangents = normal_tangents(refined.state.gravity.normalized());
  double of_scale = 0;
  for (const VectorXd& change : changes) {
    const VectorXd move = gain * refined.noise->covariance.matrixL().solve(change);
    const Vector3d turned = tangents * move.segment<2>(3);
    result.direction_covariance += turned * turned.transpose();
    result.accelerometer_bias_covariance += move.segment<3>(6) * move.segment<3>(6).transpose();
    of_scale += move(kScaleUnknown) * move(kScaleUnknown);
  }
  const double least = std::hypot(options.gravity_sigma, options.scale_factor_sigma);
  result.log_scale_sigma = std::hypot(result.log_scale_sigma, std::max(least, std::sqrt(of_scale)));
  result.gravity_sigma_deg = degrees(std::sqrt(result.direction_covariance.trace()));
}

std::string why_no_gravity(const Gyroscope& gyroscope, std::span<const Preintegration> between) {
  // In the sensor's axes at the start of each short interval, so that rotation hardly matters.
  double force = 0;
  for (const Preintegration& step : between) force += step.velocity.norm() / step.seconds;
  force /= static_cast<double>(between.size());
  if (force > kLeastForce_m_s2 && force < kMostForce_m_s2) return "";
  return fmt::format(
      "{}: the accelerometer measures {:.2f} m/s^2 on average, but gravity alone is 9.8{}",
      gyroscope.file.filename().string(),
      force,
      force > 0.8 && force < 1.25 ? "; are its values in g?" : "");
}

AlignmentProblem alignment_problem(const UncertainPoses& poses,
                                   std::span<const Preintegration> between,
                                   const Matrix3d& R_sensor_camera,
                                   const Matrix3d& bias_covariance) {
  AlignmentProblem problem;
  problem.path = inertial_path(between, R_sensor_camera.transpose());
  const Eigen::Index rows = poses.center_rows();
  problem.centers.resize(rows);
  for (std::size_t k = 1; k < poses.cameras.size(); ++k)
    problem.centers.segment<3>(3 * (static_cast<Eigen::Index>(k) - 1)) = poses.cameras[k].p_wc;
  problem.inertial_noise = position_covariance(problem.path);
  problem.covariance = poses.covariance;
  if (!poses.has_bias_covariance()) {
    problem.covariance.conservativeResizeLike(MatrixXd::Zero(rows + 3, rows + 3));
    problem.covariance.bottomRightCorner<3, 3>() = bias_covariance;
  }
  return problem;
}

/// Adds the priors of the accelerometer's bias and of the camera in sensor axes.
void add_priors(const Gyroscope& gyroscope,
                const std::optional<Pose>& T_body_camera,
                const InertialOptions& options,
                AlignmentProblem& problem) {
  const bool calibrated = T_body_camera && T_body_camera->p_wc != Vector3d::Zero();
  problem.bias_sigma_m_s2 = options.bias_sigma_m_s2;
  problem.lever_sigma_m =
      calibrated ? options.calibrated_lever_sigma_m : options.uncalibrated_lever_sigma_m;
  problem.lever_m.setZero();
  if (calibrated)
    problem.lever_m =
        gyroscope.R_gyro_camera * T_body_camera->R_wc.transpose() * T_body_camera->p_wc;
}

/// White noise of both sensors in the window.
ImuNoise noise_of(const Gyroscope& gyroscope,
                  const UncertainPoses& poses,
                  std::int64_t offset_ns,
                  const InertialOptions& options) {
  ImuNoise noise{gyroscope.noise_density, options.noise_density};
  if (gyroscope.accelerations_m_s2.size() != gyroscope.timestamps_ns.size()) return noise;
  const auto shaken = accelerometer_noise_density(
      gyroscope, poses.times_ns.front() + offset_ns, poses.times_ns.back() + offset_ns);
  // Values that are not finite are reported later.
  if (shaken && *shaken > noise.accelerometer) noise.accelerometer = *shaken;
  return noise;
}

/// Over the aligned centers, then the gyroscope's bias. Needs the noise at exactly this state: that
/// of a slightly different scale makes covariances negative.
PosePull pull_of(const AlignmentProblem& problem, const AlignmentState& state, double misfit) {
  const Eigen::Index rows = problem.centers.size();
  const auto noise = residual_noise(problem, state);
  if (!noise) return {VectorXd::Zero(rows + 3), MatrixXd::Zero(rows + 3, rows + 3)};
  MatrixXd by_poses(rows, rows + 3);
  by_poses << std::exp(state.log_scale) * MatrixXd::Identity(rows, rows),
      by_gyro_bias(problem, state);
  const MatrixXd G = noise->covariance.matrixL().solve(by_poses);
  const auto [r, J] = white_residuals(problem, state, *noise);
  const MatrixXd of_unknowns = J.transpose() * G;
  const MatrixXd left = inverse_of_symmetric(prior_of(problem) + J.transpose() * J);
  PosePull pull{G.transpose() * r, G.transpose() * G};
  pull.information.noalias() -= of_unknowns.transpose() * left * of_unknowns;
  // A misfit beyond chance is due to the accelerations, which then weigh less.
  const double chance = 3 * std::sqrt(2 / freedom_of(problem));
  if (misfit > 1 + chance) {
    pull.gradient /= misfit;
    pull.information /= misfit;
  }
  return pull;
}

}  // namespace

UncertainPoses uncertain_poses(const Window& window, const Initialization& result) {
  constexpr int kMostFrames = 60;
  const int all = window.frame_count();
  const int step = (all - 1 + kMostFrames - 1) / kMostFrames;
  UncertainPoses poses;
  std::vector<int> rows;  // chosen rows of the covariance of all centers
  for (int i = 0; i < all; i += std::max(1, step)) {
    poses.cameras.push_back(result.cameras[i]);
    poses.times_ns.push_back(window.timestamps_ns[i]);
    for (int axis = 0; i > 0 && axis < 3; ++axis) rows.push_back(3 * (i - 1) + axis);
  }
  poses.bias_rad_s = result.bias_rad_s;
  if (!poses.bias_rad_s && window.gyro) poses.bias_rad_s = window.gyro->bias_rad_s;
  poses.time_offset_correction_s = result.time_offset_correction_s.value_or(0);
  if (!result.uncertainty || result.uncertainty->joint_covariance.size() == 0) return poses;
  const Uncertainty& u = *result.uncertainty;
  for (int k = 0; k < std::min(3, u.joint_bias_rows); ++k) rows.push_back(3 * (all - 1) + k);
  poses.covariance = u.joint_covariance(rows, rows);
  poses.joint_rows = std::move(rows);
  return poses;
}

UncertainPoses first_poses(const UncertainPoses& poses, int count) {
  UncertainPoses first = poses;
  first.cameras.resize(count);
  first.times_ns.resize(count);
  std::vector<Eigen::Index> rows(first.center_rows());
  std::iota(rows.begin(), rows.end(), 0);
  for (Eigen::Index k = poses.center_rows(); k < poses.covariance.rows(); ++k) rows.push_back(k);
  first.covariance = poses.covariance(rows, rows);
  return first;
}

InertialAlignment align_inertial(const UncertainPoses& poses,
                                 const Gyroscope& gyroscope,
                                 const std::optional<Pose>& T_body_camera,
                                 const InertialOptions& options,
                                 PosePull* pull) {
  const auto begin = std::chrono::steady_clock::now();
  if (static_cast<int>(poses.cameras.size()) < kLeastFrames)
    return refused(fmt::format("gravity and metric scale need at least {} frames; there are {}",
                               kLeastFrames,
                               poses.cameras.size()));
  if (poses.covariance.size() == 0) return refused("the uncertainty of the poses is unknown");
  const auto correction_ns =
      static_cast<std::int64_t>(std::llround(1e9 * poses.time_offset_correction_s));
  const std::int64_t offset_ns = gyroscope.time_offset_ns + correction_ns;
  const ImuNoise noise = noise_of(gyroscope, poses, offset_ns, options);
  const Vector3d bias = poses.bias_rad_s.value_or(gyroscope.bias_rad_s);
  ImuIntervals measured = imu_intervals(gyroscope, poses.times_ns, offset_ns, bias, noise);
  if (!measured.reason.empty()) return refused(measured.reason);
  if (std::string reason = why_no_gravity(gyroscope, measured.between); !reason.empty())
    return refused(std::move(reason));
  const BiasFit fit = fit_bias(poses, measured.between, gyroscope.R_gyro_camera, bias);
  for (Preintegration& one : measured.between)
    one = with_biases_moved(one, fit.bias_rad_s - bias, Vector3d::Zero());

  AlignmentProblem problem =
      alignment_problem(poses, measured.between, gyroscope.R_gyro_camera, fit.covariance);
  add_priors(gyroscope, T_body_camera, options, problem);
  const Refinement refined = refine(problem, linear_start(problem, options.gravity_m_s2));
  if (!refined.noise) return refused("the covariance of the poses is not positive definite");
  InertialAlignment result;
  result.misfit = refined.cost / freedom_of(problem);
  if (!(result.misfit < kMostMisfit))
    return refused(fmt::format(
        "accelerations and poses disagree by {:.0f} times what is expected: other axes or clock?",
        std::sqrt(result.misfit)));
  result.ok = true;
  result.iterations = refined.iterations;
  result.gravity_m_s2 = refined.state.gravity;
  result.scale = std::exp(refined.state.log_scale);
  result.accelerometer_bias_m_s2 = refined.state.bias;
  result.times_ns = poses.times_ns;
  result.velocities_m_s = velocities(problem, refined.state);
  add_certainty(refined, options, result);
  const auto changes = changes_by_scales(
      problem, refined.state, measured.between, options.gravity_sigma, options.scale_factor_sigma);
  add_moves(refined, changes, options, result);
  result.milliseconds =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  if (pull != nullptr) *pull = pull_of(problem, refined.state, result.misfit);
  return result;
}

std::optional<int> poses_that_determine_scale(const UncertainPoses& poses,
                                              const Gyroscope& gyroscope,
                                              const std::optional<Pose>& T_body_camera,
                                              const InertialOptions& options) {
  const auto determined = [&](int count) {
    const auto aligned =
        align_inertial(first_poses(poses, count), gyroscope, T_body_camera, options);
    return aligned.ok && aligned.scale_known;
  };
  int too_few = 1, enough = static_cast<int>(poses.cameras.size());
  if (poses.covariance.size() == 0 || !determined(enough)) return std::nullopt;
  while (enough - too_few > 1) {
    const int between = (too_few + enough) / 2;
    (determined(between) ? enough : too_few) = between;
  }
  return enough;
}

}  // namespace gpo
