// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/gyroscope_fit.h"

#include "engine/calibration/gyroscope_alignment.h"
#include "engine/frontend/rotations.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLongEnoughForDrift_s = 60;
constexpr int kMostIterations = 30;
/// Where Huber's loss has its knee, in robust standard deviations.
constexpr double kKneeInSigmas = 2;
/// A window counts as one whose pictures disagree where its frames' median is so many times that of
/// all.
constexpr double kDisagrees = 4;
/// Beyond these nothing useful is known.
constexpr double kMostRotationSigma_deg = 5;
constexpr double kMostOffsetSigma_s = 0.03;
constexpr double kLeastCorrelation = 0.5;

/// Rotation (about the camera's axes), offset, bias, drift.
using Parameters = Eigen::Matrix<double, 8, 1>;

struct State {
  Matrix3d R_gyro_camera;
  double offset_s;
  Vector3d bias;
  double drift = 0;
};

State moved(const State& state, const Parameters& step) {
  return {state.R_gyro_camera * so3_exp(step.head<3>()),
          state.offset_s + step(3),
          state.bias + step.segment<3>(4),
          state.drift + step(7)};
}

/// One window and the samples around it.
struct Observed {
  const ImageRotations* window;
  Gyroscope samples;
  double from_middle_s;  ///< of the recording to the window's first frame
};

/// Residuals of its frames but the first [rad], 3 x n; empty where the samples do not cover it.
Eigen::Matrix3Xd residuals(const Observed& observed, const State& state) {
  Gyroscope gyroscope = observed.samples;
  gyroscope.R_gyro_camera = state.R_gyro_camera;
  gyroscope.bias_rad_s = state.bias;
  gyroscope.time_offset_ns = to_ns(state.offset_s + state.drift * observed.from_middle_s);
  const auto& window = *observed.window;
  const std::int64_t first_ns = window.timestamps_ns.front() + gyroscope.time_offset_ns;
  const std::int64_t last_ns = window.timestamps_ns.back() + gyroscope.time_offset_ns;
  if (!why_not_covered(gyroscope, first_ns, last_ns).empty()) return {};
  const std::vector<Matrix3d> R_wc = gyro_rotations(gyroscope, window.timestamps_ns);
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(R_wc.size()) - 1);
  for (std::size_t i = 1; i < R_wc.size(); ++i)
    all.col(static_cast<Eigen::Index>(i) - 1) = so3_log(window.R_wc[i].transpose() * R_wc[i]);
  return all;
}

Gyroscope samples_around(const Gyroscope& gyroscope, std::int64_t from_ns, std::int64_t to_ns) {
  const auto first = std::ranges::lower_bound(gyroscope.timestamps_ns, from_ns);
  const auto last = std::ranges::upper_bound(gyroscope.timestamps_ns, to_ns);
  const auto a = first - gyroscope.timestamps_ns.begin();
  const auto b = last - gyroscope.timestamps_ns.begin();
  Gyroscope part;
  part.file = gyroscope.file;
  part.timestamps_ns.assign(first, last);
  part.rates_rad_s.assign(gyroscope.rates_rad_s.begin() + a, gyroscope.rates_rad_s.begin() + b);
  if (gyroscope.lines.size() == gyroscope.timestamps_ns.size())
    part.lines.assign(gyroscope.lines.begin() + a, gyroscope.lines.begin() + b);
  return part;
}

std::vector<Observed> observed_windows(const std::vector<ImageRotations>& windows,
                                       const Gyroscope& gyroscope,
                                       const State& state) {
  constexpr double kMargin_s = 0.2;
  const std::int64_t middle_ns =
      windows.front().timestamps_ns.front() +
      (windows.back().timestamps_ns.back() - windows.front().timestamps_ns.front()) / 2;
  std::vector<Observed> all;
  for (const ImageRotations& window : windows) {
    const std::int64_t first_ns = window.timestamps_ns.front() + to_ns(state.offset_s - kMargin_s);
    const std::int64_t last_ns = window.timestamps_ns.back() + to_ns(state.offset_s + kMargin_s);
    const double from_middle_s =
        1e-9 * static_cast<double>(window.timestamps_ns.front() - middle_ns);
    all.push_back({&window, samples_around(gyroscope, first_ns, last_ns), from_middle_s});
    if (residuals(all.back(), state).cols() == 0) all.pop_back();
  }
  return all;
}

/// A window's share of the normal equations.
struct WindowNormals {
  Eigen::Matrix<double, 8, 8> JtJ = Eigen::Matrix<double, 8, 8>::Zero();
  Parameters Jtr = Parameters::Zero();
};

double huber(double e, double knee) { return e < knee ? 0.5 * e * e : knee * (e - 0.5 * knee); }

struct Errors {
  std::vector<Eigen::Matrix3Xd> of_window;
  double cost = 0;
};

Errors errors_of(const std::vector<Observed>& windows, const State& state, double knee) {
  Errors errors;
  for (const Observed& window : windows) {
    errors.of_window.push_back(residuals(window, state));
    if (errors.of_window.back().cols() == 0) errors.cost = std::numeric_limits<double>::infinity();
    for (const auto& r : errors.of_window.back().colwise()) errors.cost += huber(r.norm(), knee);
  }
  return errors;
}

/// By central differences; nothing where the samples do not cover them.
std::optional<WindowNormals> normals_of(const Observed& window,
                                        const State& state,
                                        const Eigen::Matrix3Xd& errors,
                                        double knee,
                                        int unknowns) {
  constexpr double kSteps[] = {1e-4, 1e-4, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4, 1e-5};
  std::vector<Eigen::Matrix3Xd> columns;
  for (int k = 0; k < unknowns; ++k) {
    const Parameters step = kSteps[k] * Parameters::Unit(k);
    const Eigen::Matrix3Xd plus = residuals(window, moved(state, step));
    const Eigen::Matrix3Xd minus = residuals(window, moved(state, -step));
    if (plus.cols() == 0 || minus.cols() == 0) return std::nullopt;
    columns.emplace_back((plus - minus) / (2 * kSteps[k]));
  }
  WindowNormals normals;
  for (Eigen::Index i = 0; i < errors.cols(); ++i) {
    Eigen::Matrix<double, 3, 8> J = Eigen::Matrix<double, 3, 8>::Zero();
    for (int k = 0; k < unknowns; ++k) J.col(k) = columns[k].col(i);
    const double e = errors.col(i).norm();
    const double weight = e < knee ? 1 : knee / e;
    normals.JtJ += weight * J.transpose() * J;
    normals.Jtr += weight * J.transpose() * errors.col(i);
  }
  return normals;
}

double robust_sigma(const Errors& errors) {
  std::vector<double> norms;
  for (const auto& of_window : errors.of_window)
    for (const auto& r : of_window.colwise()) norms.push_back(r.norm());
  return std::max(1e-6, median(norms) / 1.538);  // of the norm of three unit Gaussians
}

struct Refined {
  State state;
  Errors errors;
  std::vector<WindowNormals> normals;
  double knee = 0;
};

std::optional<Refined> refine(const std::vector<Observed>& windows, State state, int unknowns) {
  Errors errors = errors_of(windows, state, 1);
  Refined result{state, errors, {}, 0};
  double damping = 1e-6;
  for (int round = 0; round < kMostIterations; ++round) {
    const double knee = kKneeInSigmas * robust_sigma(errors);
    errors = errors_of(windows, state, knee);
    Eigen::Matrix<double, 8, 8> A = Eigen::Matrix<double, 8, 8>::Zero();
    Parameters g = Parameters::Zero();
    result = {state, errors, {}, knee};
    for (std::size_t w = 0; w < windows.size(); ++w) {
      const auto normals = normals_of(windows[w], state, errors.of_window[w], knee, unknowns);
      if (!normals) return std::nullopt;
      result.normals.push_back(*normals);
      A += normals->JtJ;
      g += normals->Jtr;
    }
    for (int k = unknowns; k < 8; ++k) A(k, k) = 1;
    bool settled = false;
    for (int tries = 0; tries < 8; ++tries) {
      Eigen::Matrix<double, 8, 8> damped = A;
      damped.diagonal() *= 1 + damping;
      const Parameters step = -solve_symmetric(damped, g);
      const State next = moved(state, step);
      if (errors_of(windows, next, knee).cost <= errors.cost) {
        damping = std::max(1e-9, damping / 10);
        state = next;
        settled = step.norm() < 1e-7;
        break;
      }
      damping *= 10;
      settled = tries == 7;
    }
    if (settled) break;
  }
  return result;
}

/// Sandwich over windows, with what few of them cost.
Eigen::MatrixXd covariance_of(const Refined& fit, int unknowns) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (const WindowNormals& w : fit.normals) A += w.JtJ.topLeftCorner(unknowns, unknowns);
  const Eigen::MatrixXd inverse = inverse_of_symmetric(A);
  // Each window's residuals as if it had been left out (Bell and McCaffrey): the step that the
  // others take without it.
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (const WindowNormals& w : fit.normals) {
    const Eigen::MatrixXd left = A - w.JtJ.topLeftCorner(unknowns, unknowns);
    const Eigen::VectorXd x = solve_symmetric(left, w.Jtr.head(unknowns));
    covariance += x * x.transpose();
  }
  const auto n = static_cast<double>(fit.normals.size());
  covariance *= (n - 1) / n;
  // Never less than independent frames would have.
  const double sigma = robust_sigma(fit.errors);
  if (covariance.trace() < sigma * sigma * inverse.trace()) covariance = sigma * sigma * inverse;
  return covariance;
}

double rms_deg(const std::vector<Eigen::Matrix3Xd>& errors) {
  double squares = 0;
  Eigen::Index count = 0;
  for (const auto& e : errors) {
    squares += e.squaredNorm();
    count += e.cols();
  }
  return degrees(std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(1, count))));
}

/// Whether rates with every axis turned around, which with a rotation is any mirror, fit far
/// better.
bool is_mirrored(const Gyroscope& gyroscope,
                 const std::vector<Interval>& intervals,
                 double around_s,
                 double cost) {
  constexpr double kFarBetter = 0.25;
  Gyroscope mirrored = gyroscope;
  for (Vector3d& rate : mirrored.rates_rad_s) rate = -rate;
  const RateIntegral integral(mirrored);
  const auto start = best_start(integral, intervals, around_s);
  return start && start->alignment.cost < kFarBetter * cost;
}

GyroscopeFit failed_fit(std::string reason) {
  GyroscopeFit fit;
  fit.reason = std::move(reason);
  return fit;
}

/// Those whose median error is not far above that of all.
std::vector<Observed> agreeing(const std::vector<Observed>& windows, const Errors& errors) {
  const double all = robust_sigma(errors);
  std::vector<Observed> kept;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const Errors one{{errors.of_window[w]}, 0};
    if (robust_sigma(one) <= kDisagrees * all) kept.push_back(windows[w]);
  }
  return kept;
}

std::string why_useless(const GyroscopeFit& fit) {
  if (fit.rotation_sigma_deg.maxCoeff() > kMostRotationSigma_deg)
    return fmt::format(
        "the camera turns too little, or about one axis only: the rotation between gyroscope and "
        "camera is known to {:.1f} deg",
        fit.rotation_sigma_deg.maxCoeff());
  if (fit.time_offset_sigma_s > kMostOffsetSigma_s)
    return fmt::format("the camera turns too evenly: the clocks' offset is known to {:.0f} ms",
                       1e3 * fit.time_offset_sigma_s);
  if (fit.correlation < kLeastCorrelation)
    return fmt::format("pictures and gyroscope turn differently: the speeds' correlation is {:.2f}",
                       fit.correlation);
  return "";
}

}  // namespace

GyroscopeFit fit_gyroscope(const std::vector<ImageRotations>& windows,
                           const Gyroscope& gyroscope) {
  const std::vector<Interval> intervals = intervals_of(windows);
  if (intervals.size() < kLeastIntervals)
    return failed_fit(fmt::format("the pictures tell {} rotations, at least {} are needed",
                                  intervals.size(),
                                  kLeastIntervals));
  const RateIntegral integral(gyroscope);
  const double recorded_offset_s = 1e-9 * static_cast<double>(gyroscope.time_offset_ns);
  const auto start = best_start(integral, intervals, recorded_offset_s);
  if (!start) return failed_fit("the gyroscope does not cover the pictures");
  State state{start->alignment.R, start->offset_s, start->alignment.bias};
  std::vector<Observed> observed = observed_windows(windows, gyroscope, state);
  const std::size_t covered = observed.size();
  if (covered < 3)
    return failed_fit(
        fmt::format("the gyroscope covers {} windows of pictures, at least 3 are needed", covered));
  const double span_s = 1e-9 * static_cast<double>(windows.back().timestamps_ns.back() -
                                                   windows.front().timestamps_ns.front());
  const int unknowns = span_s > kLongEnoughForDrift_s ? 8 : 7;
  auto refined = refine(observed, state, 7);
  if (refined) {
    observed = agreeing(observed, refined->errors);
    if (observed.size() >= 3) refined = refine(observed, refined->state, unknowns);
  }
  if (!refined || observed.size() < 3) return failed_fit("the windows' rotations do not agree");
  const Eigen::MatrixXd covariance = covariance_of(*refined, unknowns);
  const Eigen::VectorXd sigmas = covariance.diagonal().cwiseMax(0).cwiseSqrt();
  GyroscopeFit fit;
  fit.R_gyro_camera = refined->state.R_gyro_camera;
  fit.rotation_sigma_deg = sigmas.head<3>() * degrees(1);
  fit.time_offset_s = refined->state.offset_s;
  fit.time_offset_sigma_s = sigmas(3);
  fit.bias_rad_s = refined->state.bias;
  fit.bias_sigma_rad_s = sigmas.segment<3>(4);
  if (unknowns == 8) {
    fit.drift = refined->state.drift;
    fit.drift_sigma = sigmas(7);
  }
  std::vector<ImageRotations> used;
  used.reserve(observed.size());
  for (const Observed& one : observed) used.push_back(*one.window);
  fit.correlation = correlation_of(pairs_at(integral, intervals_of(used), fit.time_offset_s));
  fit.rms_deg = rms_deg(refined->errors.of_window);
  const State recorded{gyroscope.R_gyro_camera, recorded_offset_s, gyroscope.bias_rad_s};
  fit.rms_before_deg =
      rms_deg(errors_of(observed_windows(windows, gyroscope, recorded), recorded, 1).of_window);
  fit.windows = static_cast<int>(observed.size());
  fit.outliers = static_cast<int>(covered - observed.size());
  if (is_mirrored(gyroscope, intervals, recorded_offset_s, start->alignment.cost))
    fit.warnings.emplace_back(
        "the rates would fit better mirrored: one axis, or the order of two, has the wrong sign");
  fit.reason = why_useless(fit);
  fit.ok = fit.reason.empty();
  return fit;
}

RatesOverTime rates_over_time(const std::vector<ImageRotations>& windows,
                              const Gyroscope& gyroscope,
                              const GyroscopeFit& fit) {
  const RateIntegral integral(gyroscope);
  RatesOverTime rates;
  const auto camera_rate = [&](const Interval& one,
                               double offset_s,
                               const Matrix3d& R_gyro_camera,
                               const Vector3d& bias) -> Vector3d {
    const std::int64_t offset_ns = to_ns(offset_s);
    const auto rate = integral.mean_rate(one.from_ns + offset_ns, one.to_ns + offset_ns);
    if (!rate) return Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    return R_gyro_camera.transpose() * (*rate - bias);
  };
  const std::vector<Interval> intervals = intervals_of(windows);
  for (const Interval& one : intervals) {
    const std::int64_t middle_ns = one.from_ns + (one.to_ns - one.from_ns) / 2;
    rates.time_s.push_back(1e-9 * static_cast<double>(middle_ns - intervals.front().from_ns));
    rates.images_rad_s.push_back(one.rate_rad_s);
    rates.before_rad_s.push_back(camera_rate(one,
                                             1e-9 * static_cast<double>(gyroscope.time_offset_ns),
                                             gyroscope.R_gyro_camera,
                                             gyroscope.bias_rad_s));
    rates.after_rad_s.push_back(
        camera_rate(one, fit.time_offset_s, fit.R_gyro_camera, fit.bias_rad_s));
  }
  return rates;
}

}  // namespace gpo
