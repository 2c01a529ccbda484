// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/calibration_problem.h"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// (value - mean) * weight, of each unknown of a block.
template <int Size>
struct PriorError {
  Eigen::Matrix<double, Size, 1> mean;
  Eigen::Matrix<double, Size, 1> weight;

  template <typename T>
  bool operator()(const T* value, T* error) const {
    for (int k = 0; k < Size; ++k) error[k] = weight[k] * (value[k] - mean[k]);
    return true;
  }
};

/// A point's height over its plane, in pixels of the noise.
struct HeightError {
  double weight;

  template <typename T>
  bool operator()(const T* point, T* error) const {
    error[0] = weight * point[2];
    return true;
  }
};

/// By which rotation two poses and the gyroscope differ, in pixels of the noise.
struct TurnError {
  GyroRotation rotation;
  double weight;

  template <typename T>
  bool operator()(const T* pose_a, const T* pose_b, const T* bias, T* error) const {
    using Matrix = Eigen::Matrix<T, 3, 3>;
    Matrix R_a, R_b;  // plane to camera
    ceres::AngleAxisToRotationMatrix(pose_a, R_a.data());
    ceres::AngleAxisToRotationMatrix(pose_b, R_b.data());
    const Eigen::Matrix<T, 3, 1> correction =
        rotation.d_bias.cast<T>() * Eigen::Matrix<T, 3, 1>(bias[0], bias[1], bias[2]);
    Matrix R_bias;
    ceres::AngleAxisToRotationMatrix(correction.data(), R_bias.data());
    const Matrix off = (rotation.R_from_to.cast<T>() * R_bias).transpose() * (R_a * R_b.transpose());
    ceres::RotationMatrixToAngleAxis(off.data(), error);
    for (int k = 0; k < 3; ++k) error[k] *= T(weight);
    return true;
  }
};

/// How often each point of a plane is seen.
std::vector<int> view_counts(const ObservedPlane& plane) {
  std::vector<int> counts(plane.points, 0);
  for (const PlaneView& view : plane.views)
    for (const int j : view.points) ++counts[j];
  return counts;
}

/// Two points of the plane that are seen often and are far apart.
std::pair<int, int> held_points(const ObservedPlane& plane, const Eigen::Matrix3Xd& places) {
  const std::vector<int> counts = view_counts(plane);
  const int most = *std::ranges::max_element(counts);
  const auto first = static_cast<int>(std::ranges::find(counts, most) - counts.begin());
  int second = first == 0 ? 1 : 0;
  double best = -1;
  for (int j = 0; j < plane.points; ++j) {
    if (j == first) continue;
    const double worth = counts[j] * (places.col(j) - places.col(first)).norm();
    if (worth <= best) continue;
    best = worth;
    second = j;
  }
  return {first, second};
}

}  // namespace

CalibrationProblem::CalibrationProblem(const std::vector<ObservedPlane>& planes,
                                       const GyroRotations& gyro,
                                       int width,
                                       int height,
                                       const LensPrior& prior,
                                       const PlaneAdjustmentOptions& options,
                                       Adjustment& unknowns)
    : options_(options), unknowns_(unknowns) {
  problem_.AddParameterBlock(unknowns_.lens.data(), kLensUnknowns);
  free_blocks_.push_back(unknowns_.lens.data());
  if (options.holds_distortion)
    problem_.SetManifold(unknowns_.lens.data(),
                         new ceres::SubsetManifold(kLensUnknowns, {4, 5, 6, 7, kReadout}));
  const LensVector weights = options.prior_px * prior.sigma.cwiseInverse();
  problem_.AddResidualBlock(
      new ceres::AutoDiffCostFunction<PriorError<kLensUnknowns>, kLensUnknowns, kLensUnknowns>(
          new PriorError<kLensUnknowns>{prior.mean, weights}),
      nullptr,
      unknowns_.lens.data());
  sources_.push_back({.rows = kLensUnknowns, .sigma_px = options.prior_px});
  add_observations(planes, width, height);
  hold_gauge(planes);
  if (options.height_sigma > 0) add_heights();
  if (!gyro.rotations.empty()) add_rotations(planes, gyro);
}

void CalibrationProblem::add_observations(const std::vector<ObservedPlane>& planes,
                                    int width,
                                    int height) {
  auto* const loss = new ceres::HuberLoss(options_.knee_px);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].views.size(); ++i) {
      const PlaneView& view = planes[p].views[i];
      double* const pose = unknowns_.planes[p].poses[i].data();
      for (std::size_t k = 0; k < view.points.size(); ++k) {
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<ObservationError, 2, kLensUnknowns, 6, 3>(
                new ObservationError(view, static_cast<Eigen::Index>(k), width, height)),
            loss,
            unknowns_.lens.data(),
            pose,
            unknowns_.planes[p].points.col(view.points[k]).data());
        sources_.push_back({static_cast<int>(p), static_cast<int>(i), view.points[k]});
      }
      if (!view.points.empty()) free_blocks_.push_back(pose);
    }
  }
}

void CalibrationProblem::hold_gauge(const std::vector<ObservedPlane>& planes) {
  const bool flat = !(options_.height_sigma > 0);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    Eigen::Matrix3Xd& places = unknowns_.planes[p].points;
    const auto [first, second] = held_points(planes[p], places);
    for (int j = 0; j < planes[p].points; ++j) {
      double* const place = places.col(j).data();
      if (!problem_.HasParameterBlock(place)) continue;
      const bool is_held = j == first || j == second;
      if (is_held && flat) {
        problem_.SetParameterBlockConstant(place);
        continue;
      }
      if (is_held) problem_.SetManifold(place, new ceres::SubsetManifold(3, {0, 1}));
      if (flat) problem_.SetManifold(place, new ceres::SubsetManifold(3, {2}));
      free_blocks_.push_back(place);
    }
  }
}

void CalibrationProblem::add_heights() {
  const double weight = options_.noise_px / options_.height_sigma;
  for (AdjustedPlane& plane : unknowns_.planes) {
    for (Eigen::Index j = 0; j < plane.points.cols(); ++j) {
      double* const place = plane.points.col(j).data();
      if (!problem_.HasParameterBlock(place)) continue;
      problem_.AddResidualBlock(
          new ceres::AutoDiffCostFunction<HeightError, 1, 3>(new HeightError{weight}),
          nullptr,
          place);
      sources_.push_back({.rows = 1, .sigma_px = options_.noise_px});
    }
  }
}

void CalibrationProblem::add_rotations(const std::vector<ObservedPlane>& planes, const GyroRotations& gyro) {
  double* const bias = unknowns_.bias_change_rad_s.data();
  const Vector3d weights = Vector3d::Constant(options_.prior_px / gyro.bias_sigma_rad_s);
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PriorError<3>, 3, 3>(
                                new PriorError<3>{Vector3d::Zero(), weights}),
                            nullptr,
                            bias);
  sources_.push_back({.rows = 3, .sigma_px = options_.prior_px});
  free_blocks_.push_back(bias);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    std::map<int, double*> pose_of_frame;
    for (std::size_t i = 0; i < planes[p].views.size(); ++i)
      if (!planes[p].views[i].points.empty())
        pose_of_frame[planes[p].views[i].frame] = unknowns_.planes[p].poses[i].data();
    for (const GyroRotation& rotation : gyro.rotations) {
      const auto a = pose_of_frame.find(rotation.from);
      const auto b = pose_of_frame.find(rotation.to);
      if (a == pose_of_frame.end() || b == pose_of_frame.end()) continue;
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<TurnError, 3, 6, 6, 3>(
                                    new TurnError{rotation, options_.prior_px / rotation.sigma_rad}),
                                nullptr,
                                a->second,
                                b->second,
                                bias);
      sources_.push_back({.rows = 3, .sigma_px = options_.prior_px});
    }
  }
}

void CalibrationProblem::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = options_.most_iterations;
  options.function_tolerance = 1e-8;
  options.num_threads = 1;  // so that it repeats to the bit
  options.logging_type = ceres::SILENT;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (AdjustedPlane& plane : unknowns_.planes)
    for (Eigen::Index j = 0; j < plane.points.cols(); ++j)
      if (problem_.HasParameterBlock(plane.points.col(j).data()))
        ordering->AddElementToGroup(plane.points.col(j).data(), 0);
  std::vector<double*> all;
  problem_.GetParameterBlocks(&all);
  for (double* const block : all)
    if (ordering->GroupId(block) < 0) ordering->AddElementToGroup(block, 1);
  options.linear_solver_ordering = ordering;
  struct Stop : ceres::IterationCallback {
    explicit Stop(const std::stop_token& token) : stop(token) {}
    ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
      return stop.stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }
    std::stop_token stop;
  } stop(options_.stop);
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  unknowns_.usable = summary.IsSolutionUsable();
  unknowns_.cost = summary.final_cost;
}

void CalibrationProblem::evaluate(std::vector<double>& residuals, ceres::CRSMatrix& jacobian) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = free_blocks_;
  options.num_threads = 1;
  problem_.Evaluate(options, nullptr, &residuals, nullptr, &jacobian);
}

}  // namespace gpo
