// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/calibration_problem.h"

#include "engine/base/stop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/Geometry>
#include <ceres/normal_prior.h>
#include <ceres/rotation.h>

namespace gpo {
namespace {

/// Projection of a plane's point, minus its observation [px] (engine/method.md, 19).
class ReprojectionError {
 public:
  ReprojectionError(const PlaneView& view, Eigen::Index column, const PlaneData& data)
      : raw_px_(view.raw_px.col(column)), width_(data.width), height_(data.height) {
    const Eigen::Array2d place = (raw_px_.array() + 0.5) / Eigen::Array2d(width_, height_) - 0.5;
    read_px_ = data.readout_direction.dot(place.matrix()) * view.flow_px.col(column);
  }

  template <typename T>
  bool operator()(const T* lens, const T* pose, const T* point, T* error) const {
    using std::exp;
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    const T z = p[2] + pose[5];
    if (!(z > T(1e-6))) return false;
    const T x = (p[0] + pose[3]) / z;
    const T y = (p[1] + pose[4]) / z;
    const T r2 = x * x + y * y;
    const T radial = T(1) + r2 * (lens[4] + r2 * lens[5]);
    const T fx = width_ * exp(lens[0] - 0.5 * lens[1]);
    const T fy = width_ * exp(lens[0] + 0.5 * lens[1]);
    const T across = 2.0 * x * y;
    const T x_d = radial * x + lens[6] * across + lens[7] * (r2 + 2.0 * x * x);
    const T y_d = radial * y + lens[6] * (r2 + 2.0 * y * y) + lens[7] * across;
    error[0] = fx * x_d + 0.5 * (width_ - 1) + width_ * lens[2] + lens[kReadout] * read_px_.x() -
               raw_px_.x();
    error[1] = fy * y_d + 0.5 * (height_ - 1) + width_ * lens[3] + lens[kReadout] * read_px_.y() -
               raw_px_.y();
    return true;
  }

 private:
  Eigen::Vector2d raw_px_;
  Eigen::Vector2d read_px_;  ///< motion until its row is read, for a readout of 1
  double width_;
  double height_;
};

/// Rotation between two poses relative to the gyroscope's, in units of the noise.
struct RotationError {
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
    const Matrix off =
        (rotation.R_from_to.cast<T>() * R_bias).transpose() * (R_a * R_b.transpose());
    ceres::RotationMatrixToAngleAxis(off.data(), error);
    for (int k = 0; k < 3; ++k) error[k] *= T(weight);
    return true;
  }
};

std::pair<int, int> gauge_points(const ObservedPlane& plane, const Eigen::Matrix3Xd& points) {
  const std::vector<int> counts = views_of_points(plane);
  const auto first = static_cast<int>(std::ranges::max_element(counts) - counts.begin());
  int second = first == 0 ? 1 : 0;
  double best = -1;
  for (int j = 0; j < plane.points; ++j) {
    const double worth = counts[j] * (points.col(j) - points.col(first)).norm();
    if (j == first || worth <= best) continue;
    best = worth;
    second = j;
  }
  return {first, second};
}

}  // namespace

CalibrationProblem::CalibrationProblem(const PlaneData& data, Adjustment& unknowns)
    : data_(data), unknowns_(unknowns) {
  copy_unknowns();
  problem_.AddParameterBlock(lens_, kLensUnknowns);
  free_blocks_.push_back(lens_);
  if (data.options.holds_distortion)
    problem_.SetManifold(lens_, new ceres::SubsetManifold(kLensUnknowns, {4, 5, 6, 7, kReadout}));
  const LensVector weights = data.options.prior_px * data.prior.sigma.cwiseInverse();
  problem_.AddResidualBlock(
      new ceres::NormalPrior(ceres::Matrix(weights.asDiagonal()), data.prior.mean), nullptr, lens_);
  sources_.push_back({.rows = kLensUnknowns, .sigma_px = data.options.prior_px});
  add_views();
  hold_gauge();
  if (data.options.height_sigma > 0) add_heights();
  if (!data.gyro.rotations.empty()) add_rotations();
}

void CalibrationProblem::copy_unknowns() {
  std::size_t size = kLensUnknowns + 3;
  for (const AdjustedPlane& plane : unknowns_.planes)
    size += 3 * static_cast<std::size_t>(plane.points.cols()) + 6 * plane.poses.size();
  values_.reserve(size);  // pointers into it stay valid
  const auto copied = [this](const double* from, std::size_t count) {
    values_.insert(values_.end(), from, from + count);
    return values_.data() + values_.size() - count;
  };
  for (const AdjustedPlane& plane : unknowns_.planes)
    points_.push_back(copied(plane.points.data(), static_cast<std::size_t>(plane.points.size())));
  lens_ = copied(unknowns_.lens.data(), kLensUnknowns);
  for (const AdjustedPlane& plane : unknowns_.planes) {
    poses_.push_back(values_.data() + values_.size());
    for (const auto& pose : plane.poses) copied(pose.data(), 6);
  }
  bias_ = copied(unknowns_.bias_change_rad_s.data(), 3);
}

void CalibrationProblem::add_views() {
  auto* const loss = new ceres::HuberLoss(data_.options.knee_px);
  for (std::size_t p = 0; p < data_.planes.size(); ++p) {
    for (std::size_t i = 0; i < data_.planes[p].views.size(); ++i) {
      const PlaneView& view = data_.planes[p].views[i];
      for (std::size_t k = 0; k < view.points.size(); ++k) {
        problem_.AddResidualBlock(
            new ceres::AutoDiffCostFunction<ReprojectionError, 2, kLensUnknowns, 6, 3>(
                new ReprojectionError(view, static_cast<Eigen::Index>(k), data_)),
            loss,
            lens_,
            pose(p, i),
            point(p, view.points[k]));
        sources_.push_back({static_cast<int>(p), static_cast<int>(i), view.points[k]});
      }
      if (!view.points.empty()) free_blocks_.push_back(pose(p, i));
    }
  }
}

void CalibrationProblem::hold_gauge() {
  const bool flat = !(data_.options.height_sigma > 0);
  for (std::size_t p = 0; p < data_.planes.size(); ++p) {
    const auto [first, second] = gauge_points(data_.planes[p], unknowns_.planes[p].points);
    for (int j = 0; j < data_.planes[p].points; ++j) {
      double* const block = point(p, j);
      if (!problem_.HasParameterBlock(block)) continue;
      const bool is_held = j == first || j == second;
      if (is_held && flat) {
        problem_.SetParameterBlockConstant(block);
        continue;
      }
      if (is_held) problem_.SetManifold(block, new ceres::SubsetManifold(3, {0, 1}));
      if (flat) problem_.SetManifold(block, new ceres::SubsetManifold(3, {2}));
      free_blocks_.push_back(block);
    }
  }
}

void CalibrationProblem::add_heights() {
  const double weight = data_.options.noise_px / data_.options.height_sigma;
  for (std::size_t p = 0; p < unknowns_.planes.size(); ++p) {
    for (Eigen::Index j = 0; j < unknowns_.planes[p].points.cols(); ++j) {
      if (!problem_.HasParameterBlock(point(p, j))) continue;
      problem_.AddResidualBlock(
          new ceres::NormalPrior(Eigen::RowVector3d(0, 0, weight), Eigen::Vector3d::Zero()),
          nullptr,
          point(p, j));
      sources_.push_back({.rows = 1, .sigma_px = data_.options.noise_px});
    }
  }
}

void CalibrationProblem::add_rotations() {
  const double prior_px = data_.options.prior_px;
  const double weight = prior_px / data_.gyro.bias_sigma_rad_s;
  problem_.AddResidualBlock(
      new ceres::NormalPrior(weight * Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()),
      nullptr,
      bias_);
  sources_.push_back({.rows = 3, .sigma_px = prior_px});
  free_blocks_.push_back(bias_);
  for (std::size_t p = 0; p < data_.planes.size(); ++p) {
    std::map<int, double*> pose_of_frame;
    for (std::size_t i = 0; i < data_.planes[p].views.size(); ++i)
      if (!data_.planes[p].views[i].points.empty())
        pose_of_frame[data_.planes[p].views[i].frame] = pose(p, i);
    for (const GyroRotation& rotation : data_.gyro.rotations) {
      const auto a = pose_of_frame.find(rotation.from);
      const auto b = pose_of_frame.find(rotation.to);
      if (a == pose_of_frame.end() || b == pose_of_frame.end()) continue;
      problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<RotationError, 3, 6, 6, 3>(
                                    new RotationError{rotation, prior_px / rotation.sigma_rad}),
                                nullptr,
                                a->second,
                                b->second,
                                bias_);
      sources_.push_back({.rows = 3, .sigma_px = prior_px});
    }
  }
}

void CalibrationProblem::solve() {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = data_.options.most_iterations;
  options.function_tolerance = 1e-8;
  options.num_threads = 1;  // repeatable to the bit
  options.logging_type = ceres::SILENT;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (std::size_t p = 0; p < unknowns_.planes.size(); ++p)
    for (Eigen::Index j = 0; j < unknowns_.planes[p].points.cols(); ++j)
      if (problem_.HasParameterBlock(point(p, j))) ordering->AddElementToGroup(point(p, j), 0);
  std::vector<double*> all;
  problem_.GetParameterBlocks(&all);
  for (double* const block : all)
    if (ordering->GroupId(block) < 0) ordering->AddElementToGroup(block, 1);
  options.linear_solver_ordering = ordering;
  struct Stop : ceres::IterationCallback {
    ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
      return current_stop().stop_requested() ? ceres::SOLVER_ABORT : ceres::SOLVER_CONTINUE;
    }
  } stop;
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem_, &summary);
  unknowns_.lens = Eigen::Map<const LensVector>(lens_);
  unknowns_.bias_change_rad_s = Eigen::Map<const Eigen::Vector3d>(bias_);
  for (std::size_t p = 0; p < unknowns_.planes.size(); ++p) {
    AdjustedPlane& plane = unknowns_.planes[p];
    plane.points = Eigen::Map<const Eigen::Matrix3Xd>(points_[p], 3, plane.points.cols());
    for (std::size_t i = 0; i < plane.poses.size(); ++i)
      plane.poses[i] = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(pose(p, i));
  }
  unknowns_.usable = summary.IsSolutionUsable();
  unknowns_.cost = summary.final_cost;
}

void CalibrationProblem::evaluate(std::vector<double>& residuals, ceres::CRSMatrix& jacobian) {
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = free_blocks_;
  options.num_threads = 1;
  problem_.Evaluate(options, nullptr, &residuals, nullptr, &jacobian);
}

Camera camera_of(const LensVector& lens, int width, int height) {
  return {.width = width,
          .height = height,
          .fx = width * std::exp(lens[0] - 0.5 * lens[1]),
          .fy = width * std::exp(lens[0] + 0.5 * lens[1]),
          .cx = 0.5 * (width - 1) + width * lens[2],
          .cy = 0.5 * (height - 1) + width * lens[3],
          .distortion = Distortion::radial_tangential,
          .coefficients = {lens[4], lens[5], lens[6], lens[7]}};
}

LensVector lens_of(const Camera& camera) {
  LensVector lens = LensVector::Zero();
  lens.head<4>() << 0.5 * std::log(camera.fx * camera.fy / camera.width / camera.width),
      std::log(camera.fy / camera.fx), (camera.cx - 0.5 * (camera.width - 1)) / camera.width,
      (camera.cy - 0.5 * (camera.height - 1)) / camera.width;
  if (camera.distortion == Distortion::radial_tangential)
    for (std::size_t k = 0; k < std::min<std::size_t>(4, camera.coefficients.size()); ++k)
      lens[static_cast<Eigen::Index>(4 + k)] = camera.coefficients[k];
  return lens;
}

Adjustment adjust(const PlaneData& problem, const Adjustment& start) {
  Adjustment result = start;
  CalibrationProblem(problem, result).solve();
  check_stop();
  return result;
}

ViewErrors reprojection_errors(const PlaneData& problem, const Adjustment& adjustment) {
  ViewErrors errors(problem.planes.size());
  for (std::size_t p = 0; p < errors.size(); ++p) {
    const AdjustedPlane& plane = adjustment.planes[p];
    for (std::size_t i = 0; i < problem.planes[p].views.size(); ++i) {
      const PlaneView& view = problem.planes[p].views[i];
      Eigen::VectorXd& lengths = errors[p].emplace_back(view.raw_px.cols());
      for (Eigen::Index k = 0; k < lengths.size(); ++k) {
        const ReprojectionError error(view, k, problem);
        const double* const point = plane.points.col(view.points[k]).data();
        Eigen::Vector2d e;
        const bool in_front = error(adjustment.lens.data(), plane.poses[i].data(), point, e.data());
        lengths[k] = in_front ? e.norm() : std::numeric_limits<double>::infinity();
      }
    }
  }
  return errors;
}

}  // namespace gpo
