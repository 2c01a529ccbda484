// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/bundle_adjustment.h"

#include "engine/geometry/camera.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/residuals/point_view.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// Outlier limit in robust standard deviations; drops 1 % of the inliers.
constexpr double kDropAtSigmas = 3;
/// Knee of the loss in standard deviations of the expected noise.
constexpr double kHuberAtSigmas = 2;
/// The robust round only finds outliers.
constexpr SolverTolerances kRobustTolerances{1e-3, 1e-6};
/// Lower limit of the noise [pixel_unit]; without it, noise-free windows would lose observations.
constexpr double kLeastNoisePx = 0.05;
/// Two observations determine a point but hardly check it.
constexpr int kLeastObservations = 3;
/// A track slipped if a smaller share of its observations agrees, or if that in the reference frame
/// does not.
constexpr double kLeastAgreeing = 2.0 / 3.0;

/// Residual p - p_observed of a free point; parameters (camera, point).
class ObservationCost : public ceres::SizedCostFunction<2, 7, 3> {
 public:
  ObservationCost(const Intrinsics& intrinsics, const Vector2d& observed)
      : intrinsics_(intrinsics), observed_(observed) {}

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector3d> point(parameters[1]);
    const PointView view = view_point(intrinsics_,
                                      Eigen::Map<const Eigen::Quaterniond>(parameters[0]),
                                      Eigen::Map<const Vector3d>(parameters[0] + 4),
                                      point.head<2>(),
                                      point.z());
    if (!view.in_front) return false;
    write_residual(view, observed_, residuals, jacobians == nullptr ? nullptr : jacobians[0]);
    if (jacobians == nullptr) return true;
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor<2, 3>> J(jacobians[1]);
      J << view.d_pixel_1, view.d_inverse_depth;
    }
    return true;
  }

 private:
  const Intrinsics& intrinsics_;
  Vector2d observed_;
};

int widest_frame(std::span<const Pose> cameras) {
  const auto widest = std::ranges::max_element(
      cameras, {}, [](const Pose& camera) { return camera.p_wc.squaredNorm(); });
  return static_cast<int>(widest - cameras.begin());
}

struct PointTally {
  int seen = 0;
  int agreeing = 0;
  bool reference_agrees = false;
};

/// Returns the observations that agree with the bundle; see `adjust_bundle_robustly`.
std::vector<Observation> without_outliers(const Matrix3d& K,
                                          const Bundle& bundle,
                                          std::span<const Observation> observations,
                                          double least_sigma_px) {
  const std::vector<double> errors = reprojection_errors_px(K, bundle, observations);
  const double limit = kDropAtSigmas * std::max(least_sigma_px, median(errors) / kMedianOfRayleigh);
  std::vector<bool> agrees(observations.size());
  std::vector<PointTally> tally(bundle.points.cols());
  for (std::size_t k = 0; k < observations.size(); ++k) {
    agrees[k] = errors[k] <= limit && bundle.points(2, observations[k].point) > 0;
    PointTally& of_point = tally[observations[k].point];
    ++of_point.seen;
    of_point.agreeing += agrees[k] ? 1 : 0;
    of_point.reference_agrees |= agrees[k] && observations[k].frame == 0;
  }
  const int least = std::min(kLeastObservations, static_cast<int>(bundle.cameras.size()));
  std::vector<Observation> kept;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    const auto& [seen, agreeing, reference_agrees] = tally[observations[k].point];
    const bool slipped = !reference_agrees || agreeing < kLeastAgreeing * seen;
    if (agrees[k] && !slipped && agreeing >= least) kept.push_back(observations[k]);
  }
  return kept;
}

/// Residual p - p_observed of a point on the plane; parameters (camera, reference pixel, quaternion
/// of the normal).
class PlaneObservationCost : public ceres::SizedCostFunction<2, 7, 2, 4> {
 public:
  PlaneObservationCost(const Intrinsics& intrinsics, const Vector2d& observed)
      : intrinsics_(intrinsics), observed_(observed) {}

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector2d> pixel_1(parameters[1]);
    const Eigen::Map<const Eigen::Quaterniond> q_normal(parameters[2]);
    const PlaneDepth depth = depth_on_plane(intrinsics_, direction(q_normal), pixel_1);
    const PointView view = view_point(intrinsics_,
                                      Eigen::Map<const Eigen::Quaterniond>(parameters[0]),
                                      Eigen::Map<const Vector3d>(parameters[0] + 4),
                                      pixel_1,
                                      depth.inverse_depth);
    if (!view.in_front) return false;
    write_residual(view, observed_, residuals, jacobians == nullptr ? nullptr : jacobians[0]);
    if (jacobians == nullptr) return true;
    if (jacobians[1] != nullptr) {
      Eigen::Map<RowMajor<2, 2>> J(jacobians[1]);
      J = view.d_pixel_1 + view.d_inverse_depth * depth.d_pixel_1;
    }
    if (jacobians[2] != nullptr) {
      Eigen::Map<RowMajor<2, 4>> J(jacobians[2]);
      J = view.d_inverse_depth * (depth.d_normal * direction_jacobian(q_normal));
    }
    return true;
  }

 private:
  const Intrinsics& intrinsics_;
  Vector2d observed_;
};

}  // namespace

std::vector<Observation> track_observations(
    const Window& window, const std::function<bool(int frame, int track)>& accepts) {
  std::vector<Observation> observations;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.points_px[0].col(j).allFinite()) continue;
    const std::size_t before = observations.size();
    for (int i = 1; i < window.frame_count(); ++i) {
      if (accepts(i, j)) observations.push_back({i, j, window.points_px[i].col(j)});
    }
    if (observations.size() > before) observations.push_back({0, j, window.points_px[0].col(j)});
  }
  return observations;
}

Vector3d position(const Matrix3d& K, const Vector3d& point) {
  return K.inverse() * point.head<2>().homogeneous() / point.z();
}

std::vector<double> reprojection_errors_px(const Matrix3d& K,
                                           const Bundle& bundle,
                                           std::span<const Observation> observations) {
  const Intrinsics intrinsics{K, K.inverse()};
  std::vector<double> errors;
  for (const Observation& observation : observations) {
    const Pose& camera = bundle.cameras[observation.frame];
    const Vector3d point = bundle.points.col(observation.point);
    const PointView view = view_point(
        intrinsics, Eigen::Quaterniond(camera.R_wc), camera.p_wc, point.head<2>(), point.z());
    errors.push_back(view.in_front ? (view.pixel - observation.pixel).norm()
                                   : std::numeric_limits<double>::infinity());
  }
  return errors;
}

AdjustedBundle adjust_bundle(const Matrix3d& K,
                             const Bundle& start,
                             std::span<const Observation> observations,
                             const AdjustmentOptions& options,
                             const Watch& watch) {
  const Intrinsics intrinsics{K, K.inverse()};
  AdjustedBundle result{start, {}};
  std::vector<PoseBlock> cameras = pose_blocks(start.cameras);
  ceres::HuberLoss huber(options.huber_px);
  ceres::Problem::Options sharing;
  sharing.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(sharing);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  add_pose_blocks(cameras, widest_frame(start.cameras), problem, *ordering);
  for (const Observation& observation : observations) {
    double* point = result.bundle.points.col(observation.point).data();
    problem.AddResidualBlock(new ObservationCost(intrinsics, observation.pixel),
                             options.huber_px > 0 ? &huber : nullptr,
                             cameras[observation.frame].data(),
                             point);
    ordering->AddElementToGroup(point, 0);
  }
  result.solver = solve_by_schur(problem, std::move(ordering), options.tolerances, watch);
  for (std::size_t i = 1; i < cameras.size(); ++i) result.bundle.cameras[i] = pose_of(cameras[i]);
  return result;
}

RobustBundle adjust_bundle_robustly(const Matrix3d& K,
                                    const Bundle& start,
                                    std::span<const Observation> observations,
                                    double error_px,
                                    const Watch& watch) {
  std::vector<Observation> usable;
  const std::vector<double> errors = reprojection_errors_px(K, start, observations);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (std::isfinite(errors[k])) usable.push_back(observations[k]);
  }
  const double sigma_px = std::max(kLeastNoisePx * pixel_unit(K), error_px / kMedianOfRayleigh);
  const double huber_px = kHuberAtSigmas * sigma_px;
  const AdjustedBundle robust =
      adjust_bundle(K, start, usable, {huber_px, kRobustTolerances}, watch);
  RobustBundle result{
      robust.bundle, without_outliers(K, robust.bundle, usable, sigma_px), robust.solver};
  if (robust.solver.termination == Termination::failure) return result;
  AdjustedBundle final_round = adjust_bundle(K, robust.bundle, result.kept, {}, watch);
  result.bundle = std::move(final_round.bundle);
  result.solver = std::move(final_round.solver);
  result.solver.iterations += robust.solver.iterations;
  result.solver.milliseconds += robust.solver.milliseconds;
  continue_trace(robust.solver, result.solver);
  result.solver.initial_cost = 0.5 * sum_of_squares(reprojection_errors_px(K, start, usable));
  if (!result.solver.trace.empty()) result.solver.trace[0].cost = result.solver.initial_cost;
  return result;
}

Bundle free_bundle(const Matrix3d& K, const PlaneBundle& bundle) {
  const Eigen::Matrix3Xd rays = K.inverse() * bundle.pixels_1.colwise().homogeneous();
  Bundle result{bundle.cameras, Eigen::Matrix3Xd(3, rays.cols())};
  result.points << bundle.pixels_1, -bundle.normal.transpose() * rays;
  return result;
}

AdjustedPlaneBundle adjust_plane_bundle(const Matrix3d& K,
                                        const PlaneBundle& start,
                                        std::span<const Observation> observations,
                                        PlaneNormal normal,
                                        const Watch& watch) {
  const Intrinsics intrinsics{K, K.inverse()};
  AdjustedPlaneBundle result{start, {}};
  std::vector<PoseBlock> cameras = pose_blocks(start.cameras);
  Eigen::Quaterniond q_normal = rotation_from_z_axis(start.normal);
  ceres::Problem problem;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  add_pose_blocks(cameras, std::nullopt, problem, *ordering);
  problem.AddParameterBlock(q_normal.coeffs().data(), 4, new DirectionManifold);
  ordering->AddElementToGroup(q_normal.coeffs().data(), 2);
  if (normal == PlaneNormal::held) problem.SetParameterBlockConstant(q_normal.coeffs().data());
  for (const Observation& observation : observations) {
    double* pixel_1 = result.bundle.pixels_1.col(observation.point).data();
    problem.AddResidualBlock(new PlaneObservationCost(intrinsics, observation.pixel),
                             nullptr,
                             cameras[observation.frame].data(),
                             pixel_1,
                             q_normal.coeffs().data());
    ordering->AddElementToGroup(pixel_1, 0);
  }
  const auto normal_now = [&]() -> Vector3d {
    return normal == PlaneNormal::free ? direction(q_normal).normalized() : start.normal;
  };
  result.solver =
      solve_by_schur(problem, std::move(ordering), kAdjustmentTolerances, watch, normal_now);
  for (std::size_t i = 1; i < cameras.size(); ++i) result.bundle.cameras[i] = pose_of(cameras[i]);
  if (normal == PlaneNormal::free) result.bundle.normal = normal_now();
  return result;
}

}  // namespace gpo
