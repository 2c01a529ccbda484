// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/bundle/bundle_adjustment.h"

#include "engine/geometry/camera.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/residuals/point_view.h"

#include <algorithm>
#include <array>
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

/// Residual p - p_observed; parameters (camera, reference pixel and inverse depth), or (camera,
/// reference pixel, quaternion of the plane's normal).
class ObservationCost : public ceres::CostFunction {
 public:
  ObservationCost(const Intrinsics& intrinsics, const Vector2d& observed, bool on_plane)
      : intrinsics_(intrinsics), observed_(observed), on_plane_(on_plane) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = {7, on_plane ? 2 : 3};
    if (on_plane) mutable_parameter_block_sizes()->push_back(4);
  }

  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    const Eigen::Map<const Vector2d> pixel_1(parameters[1]);
    const auto q_normal = [&] { return Eigen::Map<const Eigen::Quaterniond>(parameters[2]); };
    std::optional<PlaneDepth> depth;
    if (on_plane_) depth = depth_on_plane(intrinsics_, direction(q_normal()), pixel_1);
    const PointView view = view_point(intrinsics_,
                                      Eigen::Map<const Eigen::Quaterniond>(parameters[0]),
                                      Eigen::Map<const Vector3d>(parameters[0] + 4),
                                      pixel_1,
                                      depth ? depth->inverse_depth : parameters[1][2]);
    if (!view.in_front) return false;
    Eigen::Map<Vector2d>{residuals} = view.pixel - observed_;
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr)
      Eigen::Map<RowMajor<2, 7>>{jacobians[0]} << view.d_rotation, view.d_position;
    if (jacobians[1] != nullptr && !depth)
      Eigen::Map<RowMajor<2, 3>>{jacobians[1]} << view.d_pixel_1, view.d_inverse_depth;
    if (jacobians[1] != nullptr && depth)
      Eigen::Map<RowMajor<2, 2>>{jacobians[1]} =
          view.d_pixel_1 + view.d_inverse_depth * depth->d_pixel_1;
    if (depth && jacobians[2] != nullptr)
      Eigen::Map<RowMajor<2, 4>>{jacobians[2]} =
          view.d_inverse_depth * (depth->d_normal * direction_jacobian(q_normal()));
    return true;
  }

 private:
  const Intrinsics& intrinsics_;
  Vector2d observed_;
  bool on_plane_;
};

/// Parameter block of a camera: the unit quaternion of R_wc (x y z w) and p_wc. Its tangent space
/// has 3 dimensions of rotation and 3 of position.
using PoseBlock = std::array<double, 7>;
using FreePose =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
using PoseOnSphere =
    ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::SphereManifold<3>>;

std::vector<PoseBlock> pose_blocks(std::span<const Pose> cameras) {
  std::vector<PoseBlock> blocks(cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    Eigen::Map<Eigen::Quaterniond>{blocks[i].data()} =
        Eigen::Quaterniond(cameras[i].R_wc).normalized();
    Eigen::Map<Vector3d>{blocks[i].data() + 4} = cameras[i].p_wc;
  }
  return blocks;
}

Pose pose_of(const PoseBlock& block) {
  const Eigen::Map<const Eigen::Quaterniond> q(block.data());
  return {q.normalized().toRotationMatrix(), Eigen::Map<const Vector3d>(block.data() + 4)};
}

/// Adds the cameras as unknowns of elimination group 1 and holds the first one. The farthest camera
/// keeps its distance from the origin if the scale is free.
void add_pose_blocks(std::span<const Pose> cameras,
                     bool free_scale,
                     std::span<PoseBlock> blocks,
                     ceres::Problem& problem,
                     ceres::ParameterBlockOrdering& ordering) {
  const auto farthest = std::ranges::max_element(
      cameras, {}, [](const Pose& camera) { return camera.p_wc.squaredNorm(); });
  auto* const free_pose = new FreePose;  // owned by the problem
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    double* const block = blocks[i].data();
    ceres::Manifold* manifold = free_pose;
    if (free_scale && &cameras[i] == &*farthest) manifold = new PoseOnSphere;
    problem.AddParameterBlock(block, 7, manifold);
    ordering.AddElementToGroup(block, 1);
  }
  problem.SetParameterBlockConstant(blocks.front().data());
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

Bundle bundle_on_plane(const Matrix3d& K,
                       const std::vector<Pose>& cameras,
                       const Vector3d& normal,
                       const Eigen::Matrix2Xd& pixels_1) {
  const Eigen::Matrix3Xd rays = K.inverse() * pixels_1.colwise().homogeneous();
  Bundle bundle{cameras, Eigen::Matrix3Xd(3, rays.cols()), normal};
  bundle.points << pixels_1, -normal.transpose() * rays;
  return bundle;
}

AdjustedBundle adjust_bundle(const Matrix3d& K,
                             const Bundle& start,
                             std::span<const Observation> observations,
                             const AdjustmentOptions& options,
                             const Watch& watch) {
  const Intrinsics intrinsics{K, K.inverse()};
  const bool on_plane = options.normal.has_value();
  AdjustedBundle result{start, {}};
  std::vector<PoseBlock> cameras = pose_blocks(start.cameras);
  Eigen::Quaterniond q_normal = Eigen::Quaterniond::Identity();
  ceres::HuberLoss huber(options.huber_px);
  ceres::Problem::Options sharing;
  sharing.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(sharing);
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  add_pose_blocks(start.cameras, !on_plane, cameras, problem, *ordering);
  if (on_plane) {
    q_normal = rotation_from_z_axis(start.normal);
    problem.AddParameterBlock(q_normal.coeffs().data(), 4, new DirectionManifold);
    ordering->AddElementToGroup(q_normal.coeffs().data(), 2);
  }
  const bool held = options.normal == PlaneNormal::held;
  if (held) problem.SetParameterBlockConstant(q_normal.coeffs().data());
  for (const Observation& observation : observations) {
    double* point = result.bundle.points.col(observation.point).data();
    std::vector<double*> blocks{cameras[observation.frame].data(), point};
    if (on_plane) blocks.push_back(q_normal.coeffs().data());
    problem.AddResidualBlock(new ObservationCost(intrinsics, observation.pixel, on_plane),
                             options.huber_px > 0 ? &huber : nullptr,
                             blocks);
    ordering->AddElementToGroup(point, 0);
  }
  const auto normal = [&]() -> Vector3d {
    return held ? start.normal : direction(q_normal).normalized();
  };
  result.solver = solve_by_schur(problem,
                                 std::move(ordering),
                                 options.tolerances,
                                 watch,
                                 on_plane ? ReadNormal(normal) : nullptr);
  for (std::size_t i = 1; i < cameras.size(); ++i) result.bundle.cameras[i] = pose_of(cameras[i]);
  if (on_plane)
    result.bundle =
        bundle_on_plane(K, result.bundle.cameras, normal(), result.bundle.points.topRows<2>());
  return result;
}

AdjustedBundle adjust_bundle_robustly(const Matrix3d& K,
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
  AdjustedBundle robust = adjust_bundle(K, start, usable, {huber_px, kRobustTolerances}, watch);
  robust.kept = without_outliers(K, robust.bundle, usable, sigma_px);
  if (robust.solver.termination == Termination::failure) return robust;
  AdjustedBundle result = adjust_bundle(K, robust.bundle, robust.kept, {}, watch);
  result.kept = std::move(robust.kept);
  result.solver.iterations += robust.solver.iterations;
  result.solver.milliseconds += robust.solver.milliseconds;
  continue_trace(robust.solver, result.solver);
  result.solver.initial_cost = 0.5 * sum_of_squares(reprojection_errors_px(K, start, usable));
  if (!result.solver.trace.empty()) result.solver.trace[0].cost = result.solver.initial_cost;
  return result;
}

}  // namespace gpo
