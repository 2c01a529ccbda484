// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/gyroscope_fit.h"

#include "engine/base/error.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"
#include "engine/rotations/rotations.h"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr double kLongEnoughForDrift_s = 60;
constexpr int kMostRounds = 30;         // each with another knee of the loss
constexpr int kStepsARound = 4;         // solver iterations
constexpr double kSettled = 1e-7;       // norm of the last round's step
constexpr double kKneeInSigmas = 2;     // knee of Huber's loss, in robust standard deviations
constexpr double kMostWindowSigma = 4;  // window's robust sigma relative to that of all

constexpr double kMostRotationSigma_deg = 5;
constexpr double kMostOffsetSigma_s = 0.03;
constexpr double kLeastCorrelation = 0.5;
constexpr double kLeastSpread_rad_s = 0.1;  // smaller rates are noise of the images

/// Steps of rotation (about the camera's axes), offset, bias, drift.
constexpr int kUnknowns = 8;
using Step = Eigen::Matrix<double, kUnknowns, 1>;

struct State {
  Matrix3d R_gyro_camera;
  double offset_s;
  Vector3d bias;
  double drift = 0;
};

State moved(const State& state, const Step& step) {
  return {state.R_gyro_camera * so3_exp(step.head<3>()),
          state.offset_s + step(3),
          state.bias + step.segment<3>(4),
          state.drift + step(7)};
}

struct Observed {
  const ImageRotations* window;
  Gyroscope samples;
  double from_middle_s;  ///< time of the window's first frame
};

/// Residuals of all frames but the first [rad], 3 x n; empty if the samples do not cover them.
Matrix3Xd residuals(const Observed& observed, const State& state) {
  Gyroscope gyroscope = observed.samples;
  gyroscope.R_gyro_camera = state.R_gyro_camera;
  gyroscope.bias_rad_s = state.bias;
  gyroscope.time_offset_ns = to_ns(state.offset_s + state.drift * observed.from_middle_s);
  const auto& window = *observed.window;
  const std::int64_t first_ns = window.timestamps_ns.front() + gyroscope.time_offset_ns;
  const std::int64_t last_ns = window.timestamps_ns.back() + gyroscope.time_offset_ns;
  if (!why_not_covered(gyroscope, first_ns, last_ns).empty()) return {};
  const std::vector<Matrix3d> R_wc = gyro_rotations(gyroscope, window.timestamps_ns);
  Matrix3Xd all(3, static_cast<Eigen::Index>(R_wc.size()) - 1);
  for (std::size_t i = 1; i < R_wc.size(); ++i)
    all.col(static_cast<Eigen::Index>(i) - 1) = so3_log(window.R_wc[i].transpose() * R_wc[i]);
  return all;
}

/// Scales residuals so that half of their squared norms are Huber's loss.
Matrix3Xd huberized(Matrix3Xd all, double knee) {
  for (auto r : all.colwise()) {
    const double e = r.norm();
    if (e > knee) r *= std::sqrt(knee * (2 * e - knee)) / e;
  }
  return all;
}

/// Derivatives of the huberized residuals by the step, 3n x `unknowns`; nullopt if not covered.
std::optional<Eigen::MatrixXd> jacobian(
    const Observed& observed, const State& state, const Step& at, double knee, int unknowns) {
  constexpr double kSteps[kUnknowns] = {1e-4, 1e-4, 1e-4, 1e-3, 1e-4, 1e-4, 1e-4, 1e-5};
  Eigen::MatrixXd J(3 * (std::ssize(observed.window->R_wc) - 1), unknowns);
  for (int k = 0; k < unknowns; ++k) {
    const Step step = kSteps[k] * Step::Unit(k);
    const Matrix3Xd plus = huberized(residuals(observed, moved(state, at + step)), knee);
    const Matrix3Xd minus = huberized(residuals(observed, moved(state, at - step)), knee);
    if (plus.cols() == 0 || minus.cols() == 0) return std::nullopt;
    J.col(k) = ((plus - minus) / (2 * kSteps[k])).reshaped();
  }
  return J;
}

class WindowCost : public ceres::CostFunction {
 public:
  WindowCost(const Observed& observed, const State& state, double knee, int unknowns)
      : observed_(observed), state_(state), knee_(knee) {
    set_num_residuals(3 * (static_cast<int>(observed.window->R_wc.size()) - 1));
    mutable_parameter_block_sizes()->push_back(unknowns);
  }
  bool Evaluate(double const* const* parameters,
                double* values,
                double** jacobians) const override {
    const int unknowns = parameter_block_sizes()[0];
    Step step = Step::Zero();
    std::copy_n(parameters[0], unknowns, step.data());
    const Matrix3Xd all = huberized(residuals(observed_, moved(state_, step)), knee_);
    if (all.cols() == 0) return false;
    std::copy_n(all.data(), all.size(), values);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    const auto J = jacobian(observed_, state_, step, knee_, unknowns);
    if (!J) return false;
    Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        jacobians[0], J->rows(), J->cols()) = *J;
    return true;
  }

 private:
  const Observed& observed_;
  const State& state_;
  double knee_;
};

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
    all.push_back({&window, samples_between(gyroscope, first_ns, last_ns), from_middle_s});
    if (residuals(all.back(), state).cols() == 0) all.pop_back();
  }
  return all;
}

using Errors = std::vector<Matrix3Xd>;  // residuals of each window

Errors errors_of(const std::vector<Observed>& windows, const State& state) {
  Errors errors;
  for (const Observed& window : windows) errors.push_back(residuals(window, state));
  return errors;
}

double robust_sigma(const Errors& errors) {
  std::vector<double> norms;
  for (const auto& of_window : errors)
    for (const auto& r : of_window.colwise()) norms.push_back(r.norm());
  return std::max(1e-6, median(norms) / 1.538);  // median norm of three standard normal variables
}

struct WindowNormals {
  Eigen::MatrixXd JtJ;
  Eigen::VectorXd Jtr;
};

struct Refined {
  State state;
  Errors errors;
  std::vector<WindowNormals> normals;
};

std::optional<WindowNormals> normals_of(const Observed& observed,
                                        const State& state,
                                        double knee,
                                        int unknowns) {
  const Matrix3Xd errors = residuals(observed, state);
  const auto J = jacobian(observed, state, Step::Zero(), INFINITY, unknowns);
  if (!J || errors.cols() == 0) return std::nullopt;
  Eigen::MatrixXd weighted = *J;
  for (Eigen::Index i = 0; i < errors.cols(); ++i)
    weighted.middleRows<3>(3 * i) *= std::min(1.0, knee / errors.col(i).norm());
  return WindowNormals{weighted.transpose() * *J, weighted.transpose() * errors.reshaped()};
}

std::optional<Step> solver_step(const std::vector<Observed>& windows,
                                const State& state,
                                double knee,
                                int unknowns) {
  Step step = Step::Zero();
  ceres::Problem problem;
  for (const Observed& window : windows)
    problem.AddResidualBlock(new WindowCost(window, state, knee, unknowns), nullptr, step.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = kStepsARound;
  options.function_tolerance = 1e-14;
  options.gradient_tolerance = 1e-14;
  options.num_threads = 1;  // repeatable to the bit
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return summary.IsSolutionUsable() ? std::optional(step) : std::nullopt;
}

std::optional<Refined> refine(const std::vector<Observed>& windows, State state, int unknowns) {
  double knee = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    knee = kKneeInSigmas * robust_sigma(errors_of(windows, state));
    const auto step = solver_step(windows, state, knee, unknowns);
    if (!step) return std::nullopt;
    state = moved(state, *step);
    if (step->norm() < kSettled) break;
  }
  Refined result{state, errors_of(windows, state), {}};
  for (const Observed& window : windows) {
    const auto normals = normals_of(window, state, knee, unknowns);
    if (!normals) return std::nullopt;
    result.normals.push_back(*normals);
  }
  return result;
}

/// Returns the larger one of the variances by the sandwich over windows, corrected for their small
/// number, and of those by the least squares.
Eigen::VectorXd variances_of(const Refined& fit, int unknowns) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (const WindowNormals& w : fit.normals) A += w.JtJ;
  const Eigen::MatrixXd inverse = inverse_of_symmetric(A);
  // Each window's residuals as if it had been left out (Bell and McCaffrey).
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(unknowns, unknowns);
  for (const WindowNormals& w : fit.normals) {
    const Eigen::VectorXd x = solve_symmetric(A - w.JtJ, w.Jtr);
    covariance += x * x.transpose();
  }
  const auto n = static_cast<double>(fit.normals.size());
  covariance *= (n - 1) / n;
  covariance *= (n - 1) / std::max(1.0, n - 3);  // the variance of Student's t with n - 1 degrees
  const double sigma = robust_sigma(fit.errors);
  return covariance.diagonal().cwiseMax(sigma * sigma * inverse.diagonal());
}

double rms_deg(const Errors& errors) {
  double squares = 0;
  Eigen::Index count = 0;
  for (const auto& e : errors) {
    squares += e.squaredNorm();
    count += e.cols();
  }
  return degrees(std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(1, count))));
}

/// True if rates about inverted axes, which with a rotation are any mirrored axes, fit far better.
bool is_mirrored(const Gyroscope& gyroscope,
                 const std::vector<Interval>& intervals,
                 double around_s,
                 double cost) {
  constexpr double kFarBetter = 0.25;
  Gyroscope mirrored = gyroscope;
  for (Vector3d& rate : mirrored.rates_rad_s) rate = -rate;
  const auto alignment = best_alignment(RateIntegral(mirrored), intervals, around_s);
  return alignment && alignment->cost < kFarBetter * cost;
}

GyroscopeFit failed_fit(std::string reason) {
  GyroscopeFit fit;
  fit.reason = std::move(reason);
  return fit;
}

std::vector<Observed> agreeing(const std::vector<Observed>& windows, const Errors& errors) {
  const double all = robust_sigma(errors);
  std::vector<Observed> kept;
  for (std::size_t w = 0; w < windows.size(); ++w)
    if (robust_sigma({errors[w]}) <= kMostWindowSigma * all) kept.push_back(windows[w]);
  return kept;
}

/// Standard deviation of the magnitudes of rates.
double spread_of(const Matrix3Xd& rates) {
  const Eigen::ArrayXd norms = rates.colwise().norm().transpose();
  return std::sqrt((norms - norms.mean()).square().mean());
}

std::string why_useless(const GyroscopeFit& fit) {
  if (fit.differs)
    return fmt::format(
        "images and gyroscope turn differently: their rates have a correlation of {:.2f}",
        fit.correlation);
  if (!(fit.rotation_sigma_deg.array() <= kMostRotationSigma_deg).all())
    return fmt::format(
        "the camera turns too little, or about one axis only: the rotation between gyroscope and "
        "camera is uncertain by {:.1f} deg",
        fit.rotation_sigma_deg.maxCoeff());
  if (fit.time_offset_sigma_s > kMostOffsetSigma_s)
    return fmt::format("the camera turns too evenly: the clock offset is uncertain by {:.0f} ms",
                       1e3 * fit.time_offset_sigma_s);
  if (fit.correlation < kLeastCorrelation)
    return fmt::format(
        "the camera turns too little: its rates and the gyroscope's have a "
        "correlation of {:.2f}",
        fit.correlation);
  return "";
}

}  // namespace

GyroscopeFit fit_gyroscope(const std::vector<ImageRotations>& windows, const Gyroscope& gyroscope) {
  const std::vector<Interval> intervals = intervals_of(windows);
  if (intervals.size() < kLeastIntervals)
    return failed_fit(fmt::format("the images determine {}, at least {} are needed",
                                  counted(intervals.size(), "rotation"),
                                  kLeastIntervals));
  const RateIntegral integral(gyroscope);
  const double recorded_offset_s = 1e-9 * static_cast<double>(gyroscope.time_offset_ns);
  const auto start = best_alignment(integral, intervals, recorded_offset_s);
  if (!start) return failed_fit("the gyroscope does not cover the images");
  const State state{start->R, start->offset_s, start->bias};
  std::vector<Observed> observed = observed_windows(windows, gyroscope, state);
  const std::size_t covered = observed.size();
  if (covered < 3)
    return failed_fit(fmt::format("the gyroscope covers {} of images, at least 3 are needed",
                                  counted(covered, "window")));
  const double span_s = 1e-9 * static_cast<double>(windows.back().timestamps_ns.back() -
                                                   windows.front().timestamps_ns.front());
  const int unknowns = span_s > kLongEnoughForDrift_s ? kUnknowns : kUnknowns - 1;
  auto refined = refine(observed, state, kUnknowns - 1);
  if (refined) {
    observed = agreeing(observed, refined->errors);
    if (observed.size() >= 3) refined = refine(observed, refined->state, unknowns);
  }
  if (!refined || observed.size() < 3) return failed_fit("the rotations of the windows disagree");
  const Eigen::VectorXd sigmas = variances_of(*refined, unknowns).cwiseMax(0).cwiseSqrt();
  GyroscopeFit fit;
  fit.R_gyro_camera = refined->state.R_gyro_camera;
  fit.rotation_sigma_deg = sigmas.head<3>() * degrees(1);
  fit.time_offset_s = refined->state.offset_s;
  fit.time_offset_sigma_s = sigmas(3);
  fit.bias_rad_s = refined->state.bias;
  fit.bias_sigma_rad_s = sigmas.segment<3>(4);
  if (unknowns == kUnknowns) {
    fit.drift = refined->state.drift;
    fit.drift_sigma = sigmas(7);
  }
  std::vector<ImageRotations> used;
  for (const Observed& one : observed) used.push_back(*one.window);
  const Pairs pairs = pairs_at(integral, intervals_of(used), fit.time_offset_s);
  fit.correlation = correlation_of(pairs);
  fit.differs =
      fit.correlation < kLeastCorrelation && spread_of(pairs.gyroscope) > kLeastSpread_rad_s;
  fit.rms_deg = rms_deg(refined->errors);
  const State recorded{gyroscope.R_gyro_camera, recorded_offset_s, gyroscope.bias_rad_s};
  fit.rms_before_deg = rms_deg(errors_of(observed_windows(windows, gyroscope, recorded), recorded));
  fit.windows = static_cast<int>(observed.size());
  fit.outliers = static_cast<int>(covered - observed.size());
  if (is_mirrored(gyroscope, intervals, recorded_offset_s, start->cost))
    fit.warnings.emplace_back(
        "mirrored rates would fit better: one axis, or the order of two, has the wrong sign");
  fit.reason = why_useless(fit);
  fit.ok = fit.reason.empty();
  return fit;
}

void add_lens_error(GyroscopeFit& fit, const Camera& camera) {
  const double typical_px = kTypicalLensShare * camera.width;
  const double cx_px = camera.sigmas.empty() ? typical_px : camera.sigmas[2];
  const double cy_px = camera.sigmas.empty() ? typical_px : camera.sigmas[3];
  Vector3d& sigma_deg = fit.rotation_sigma_deg;
  sigma_deg.x() = std::hypot(sigma_deg.x(), degrees(cy_px / camera.fy));
  sigma_deg.y() = std::hypot(sigma_deg.y(), degrees(cx_px / camera.fx));
}

}  // namespace gpo
