// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/time_offset.h"

#include "engine/geometry/statistics.h"
#include "engine/window/timestamps.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

namespace gpo {
namespace {

constexpr double kRange_s = 0.5;
constexpr int kMostSteps = 1000;
constexpr std::size_t kLeastSteps = 8;

double seconds(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

/// The rotation of the reference from one time to the next.
struct Step {
  std::int64_t from_ns = 0, to_ns = 0;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< in the first camera [rad]
  /// Derivative of `rotation` by the times of both ends, from the steps before and after [rad/s].
  Eigen::Vector3d change = Eigen::Vector3d::Zero();
  double length_s() const { return seconds(to_ns - from_ns); }
};

/// Returns indices of the reference at least `least_ns` apart.
std::vector<std::size_t> thinned(const ClockReference& reference, std::int64_t least_ns) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < reference.timestamps_ns.size(); ++i)
    if (kept.empty() ||
        reference.timestamps_ns[i] - reference.timestamps_ns[kept.back()] >= least_ns)
      kept.push_back(i);
  return kept;
}

/// Returns steps with a step before and after them; drops those over gaps and, evenly, all beyond a
/// number.
std::vector<Step> steps_of(const ClockReference& reference, std::int64_t least_ns) {
  const auto& times_ns = reference.timestamps_ns;
  const std::vector<std::size_t> kept = thinned(reference, least_ns);
  std::vector<Step> all;
  for (std::size_t k = 0; k + 1 < kept.size(); ++k) {
    const Eigen::Matrix3d R = reference.R_wc[kept[k]].transpose() * reference.R_wc[kept[k + 1]];
    all.push_back({times_ns[kept[k]], times_ns[kept[k + 1]], so3_log(R)});
  }
  if (all.size() < 3) return {};
  std::vector<double> lengths;
  for (const Step& step : all) lengths.push_back(step.length_s());
  const double longest = 2 * median(lengths);
  std::vector<Step> steps;
  for (std::size_t k = 1; k + 1 < all.size(); ++k) {
    const Step &before = all[k - 1], &after = all[k + 1];
    Step step = all[k];
    const bool gap = std::max({before.length_s(), step.length_s(), after.length_s()}) > longest;
    if (gap) continue;
    // Rotations of different lengths are compared as rates.
    const Eigen::Vector3d acceleration =
        (after.rotation / after.length_s() - before.rotation / before.length_s()) /
        (0.5 * seconds(after.to_ns + after.from_ns - before.to_ns - before.from_ns));
    step.change = acceleration * step.length_s();
    steps.push_back(step);
  }
  const std::size_t stride = (steps.size() + kMostSteps - 1) / kMostSteps;
  for (std::size_t k = 0; stride > 1 && k * stride < steps.size(); ++k)
    steps[k] = steps[k * stride];
  if (stride > 1) steps.resize((steps.size() + stride - 1) / stride);
  return steps;
}

/// A step and the rotation by which the result differs from it.
struct Difference {
  const Step* step = nullptr;
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< [rad]
};

class OffsetProblem {
 public:
  OffsetProblem(const ResultPoses& result,
                const Pose& T_posed_camera,
                const ClockReference& reference,
                int step)
      : result_(result),
        R_posed_camera_(T_posed_camera.R_wc),
        period_ns_(median_period_ns(result.timestamps_ns)),
        steps_(steps_of(reference, step * period_ns_ - period_ns_ / 4)),
        rates_are_biased_(reference.rates_are_biased) {}

  const std::vector<Step>& steps() const { return steps_; }
  std::int64_t period_ns() const { return period_ns_; }

  std::vector<Difference> differences(double offset_s) const {
    const auto offset_ns = static_cast<std::int64_t>(std::llround(1e9 * offset_s));
    const std::int64_t most_ns = period_ns_ * 5 / 2;
    std::vector<Difference> all;
    for (const Step& step : steps_) {
      const auto from = pose_at(result_, step.from_ns - offset_ns, most_ns);
      if (!from) continue;
      const auto to = pose_at(result_, step.to_ns - offset_ns, most_ns);
      if (!to) continue;
      const Eigen::Matrix3d R =
          (from->R_wc * R_posed_camera_).transpose() * to->R_wc * R_posed_camera_;
      all.push_back({&step, so3_log(so3_exp(step.rotation).transpose() * R)});
    }
    return all;
  }

  /// Mean difference, for the search; infinite for too few steps in common.
  double cost(double offset_s) const {
    const std::vector<Difference> all = differences(offset_s);
    if (all.size() < std::max(kLeastSteps, std::min(steps_.size(), result_.poses.size()) / 4))
      return std::numeric_limits<double>::infinity();
    Eigen::Vector3d bias = Eigen::Vector3d::Zero();
    if (rates_are_biased_)
      for (const Difference& one : all)
        bias += one.rotation / (one.step->length_s() * static_cast<double>(all.size()));
    double sum = 0;
    for (const Difference& one : all) sum += (one.rotation - one.step->length_s() * bias).norm();
    return sum / static_cast<double>(all.size());
  }

  /// One step of Gauss and Newton with Huber's weights. The derivatives come from the reference,
  /// whose noise is independent: those of the interpolated result would favor the middle between
  /// its poses, where interpolation averages its noise. Returns nullopt if undetermined.
  std::optional<TimeOffset> refined(double offset_s) const {
    const std::vector<Equation> equations = equations_of(differences(offset_s));
    if (equations.size() < kLeastSteps) return std::nullopt;
    Eigen::Matrix4d A = Eigen::Matrix4d::Zero();
    Eigen::Vector4d g = Eigen::Vector4d::Zero();
    for (const Equation& one : equations) {
      A += one.weight * one.J.transpose() * one.J;
      g += one.weight * one.J.transpose() * one.r;
    }
    if (!rates_are_biased_) A.bottomRightCorner<3, 3>().setIdentity();
    const Eigen::LDLT<Eigen::Matrix4d> factors(A);
    if (factors.info() != Eigen::Success || !factors.isPositive()) return std::nullopt;
    const Eigen::Vector4d step = -factors.solve(g);
    // The noise of the reference adds to A, but not to the information on the offset.
    const double noise = noise_in_derivatives(equations, step), signal = A(0, 0) - noise;
    if (!(signal > noise)) return std::nullopt;
    const double amplified = A(0, 0) / signal;
    const Eigen::Matrix4d inverse = factors.solve(Eigen::Matrix4d::Identity());
    const double variance = (inverse * gradient_covariance(equations, step) * inverse)(0, 0);
    const double moved = offset_s + amplified * step(0);
    if (!std::isfinite(moved) || !(variance >= 0)) return std::nullopt;
    return TimeOffset{moved, amplified * std::sqrt(variance)};
  }

 private:
  /// J x + r of a step; x: changes of the offset and of the gyroscope's bias.
  struct Equation {
    Eigen::Matrix<double, 3, 4> J = Eigen::Matrix<double, 3, 4>::Zero();
    Eigen::Vector3d r = Eigen::Vector3d::Zero();
    double weight = 1;
    double length_s = 0;
  };

  std::vector<Equation> equations_of(const std::vector<Difference>& all) const {
    constexpr double kHuber = 1.345;
    if (all.empty()) return {};
    std::vector<double> norms;
    for (const Difference& one : all) norms.push_back(one.rotation.norm());
    const double scale = std::max(1e-12, median(std::move(norms)));
    std::vector<Equation> equations;
    for (const auto& [step, r] : all) {
      Equation& one = equations.emplace_back();
      one.J.col(0) = -step->change;  // a later result is read at an earlier time
      if (rates_are_biased_) one.J.rightCols<3>() = step->length_s() * Eigen::Matrix3d::Identity();
      one.r = r;
      one.weight = huber_weight(r.norm(), kHuber * scale);
      one.length_s = step->length_s();
    }
    return equations;
  }

  /// Returns the part of A(0, 0) by the noise of the reference, at most half of that of the
  /// residuals: derivatives are differences of two steps, two lengths apart.
  static double noise_in_derivatives(const std::vector<Equation>& equations,
                                     const Eigen::Vector4d& x) {
    double noise = 0;
    for (const Equation& one : equations)
      noise += one.weight * (one.r + one.J * x).squaredNorm() / (2 * one.length_s * one.length_s);
    return noise;
  }

  /// Covariance of the gradient with correlations of neighboring steps, which share poses (Newey
  /// and West 1987).
  static Eigen::Matrix4d gradient_covariance(const std::vector<Equation>& equations,
                                             const Eigen::Vector4d& x) {
    const int count = static_cast<int>(equations.size());
    const int lags = std::clamp(count / 10, 1, 15);
    std::vector<Eigen::Vector4d> gradients;
    for (const Equation& one : equations)
      gradients.emplace_back(one.weight * one.J.transpose() * (one.r + one.J * x));
    Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
    for (int i = 0; i < count; ++i)
      for (int lag = 0; lag <= lags && i + lag < count; ++lag) {
        const Eigen::Matrix4d product = gradients[i] * gradients[i + lag].transpose();
        const double weight = 1 - lag / (lags + 1.0);
        sum += lag == 0 ? product : Eigen::Matrix4d(weight * (product + product.transpose()));
      }
    return sum;
  }

  const ResultPoses& result_;
  const Eigen::Matrix3d R_posed_camera_;
  const std::int64_t period_ns_;
  const std::vector<Step> steps_;
  const bool rates_are_biased_;
};

/// Returns the offset on a grid with the least cost; nullopt if that is at an end of the range.
std::optional<double> searched(const OffsetProblem& problem) {
  const double spacing_s = std::clamp(0.5 * seconds(problem.period_ns()), 0.004, 0.02);
  const int most = static_cast<int>(std::ceil(kRange_s / spacing_s));
  std::optional<int> best;
  double least = std::numeric_limits<double>::infinity();
  for (int k = -most; k <= most; ++k) {
    const double cost = problem.cost(k * spacing_s);
    if (!(cost < least)) continue;
    least = cost;
    best = k;
  }
  if (!best || std::abs(*best) == most) return std::nullopt;
  return *best * spacing_s;
}

std::optional<TimeOffset> solved(const OffsetProblem& problem) {
  constexpr int kMostIterations = 30;
  constexpr double kConverged_s = 1e-7;
  const auto start = searched(problem);
  double offset_s = start.value_or(0);
  for (int i = 0; start && i < kMostIterations; ++i) {
    const auto next = problem.refined(offset_s);
    if (!next || std::abs(next->seconds) > kRange_s) return std::nullopt;
    const bool converged = std::abs(next->seconds - offset_s) < kConverged_s;
    if (converged || i + 1 == kMostIterations) return next;
    offset_s = next->seconds;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Pose> pose_at(const ResultPoses& result, std::int64_t time_ns, std::int64_t most_ns) {
  const auto& times = result.timestamps_ns;
  const auto after = std::ranges::lower_bound(times, time_ns);
  if (after == times.end()) return std::nullopt;
  const auto index = after - times.begin();
  if (*after == time_ns) return result.poses[index];
  if (index == 0 || times[index] - times[index - 1] > most_ns) return std::nullopt;
  const Pose &a = result.poses[index - 1], &b = result.poses[index];
  const double share = static_cast<double>(time_ns - times[index - 1]) /
                       static_cast<double>(times[index] - times[index - 1]);
  return Pose{a.R_wc * so3_exp(share * so3_log(a.R_wc.transpose() * b.R_wc)),
              a.p_wc + share * (b.p_wc - a.p_wc)};
}

std::optional<TimeOffset> estimate_time_offset(const ResultPoses& result,
                                               const Pose& T_posed_camera,
                                               const ClockReference& reference) {
  constexpr double kLongest_s = 0.25;
  if (result.by != FoundBy::time || result.poses.size() < kLeastSteps ||
      seconds(median_period_ns(result.timestamps_ns)) > kLongest_s)
    return std::nullopt;
  std::optional<TimeOffset> best;
  for (const int step : {1, 2, 4}) {  // longer steps reduce noise, shorter ones have more detail
    const OffsetProblem problem(result, T_posed_camera, reference, step);
    const auto one = problem.steps().size() < kLeastSteps ? std::nullopt : solved(problem);
    if (one && (!best || one->sigma_s < best->sigma_s)) best = one;
  }
  const double period_s = seconds(median_period_ns(result.timestamps_ns));
  return best && best->sigma_s < 0.5 * period_s ? best : std::nullopt;
}

}  // namespace gpo
