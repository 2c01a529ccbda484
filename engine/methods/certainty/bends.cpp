// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/bends.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/certainty/sandwich.h"
#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/certainty/solution_moves.h"
#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/plane/rolling_shutter.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <Eigen/LU>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Quadratic = Eigen::Matrix<double, 6, 1>;  // 1, a, b, a^2, ab, b^2

constexpr std::size_t kLeastHeights = 12;  // twice the number of the quadratic's coefficients
/// Chi-square limit with three degrees of freedom, exceeded by noise once in 1000 windows.
constexpr double kLeastBend = 16.27;

/// A track's height above its plane, from all frames that see it.
struct Height {
  Vector2d place = {};     ///< along the plane's tangents [distance of the main plane]
  double gradient = 0;     ///< gradient of the cost over the log of the distance [px^2]
  double information = 0;  ///< [px^2]
};

std::vector<Height> heights_of(const SolvedPlanes& solved, int plane) {
  const Vector3d m = plane == 0 ? solved.motion.normal : solved.motion.others[plane - 1].m;
  const auto tangents = normal_tangents(m.normalized());
  std::vector<Height> heights(solved.window.track_count());
  for (int i = 1; i < solved.frame_count(); ++i) {
    const FrameObservations& f = solved.observations.plane(plane)[i];
    const FrameState state = frame_state(solved.observations, solved.motion, i, plane);
    for (int k = 0; k < f.count; ++k) {
      const Transfer transfer = transfer_of(f, state, k);
      const Vector2d dp = transfer.d_normal() * m;
      const double weight = f.mask[k] * f.mask[k];
      Height& height = heights[f.track[k]];
      height.place = tangents.transpose() * transfer.ray_1 / -transfer.height;
      height.gradient += weight * dp.dot(transfer.pixel - Vector2d(f.u[k], f.v[k]));
      height.information += weight * dp.squaredNorm();
    }
  }
  std::vector<Height> known;
  std::ranges::copy_if(heights, std::back_inserter(known), [](const Height& height) {
    return height.information > 0;
  });
  return known;
}

/// Second derivatives of a plane's surface: coefficients of a^2, ab, b^2 [1 / d].
struct Curvature {
  Vector3d value;
  Eigen::Matrix3d information;  ///< times the variance of the noise [d^2 px^2]
};

/// A quadratic fitted to the heights of a plane's tracks, with the motion held.
struct Surface {
  Vector2d center;         ///< mean of the tracks' places [d]
  Eigen::Matrix2d spread;  ///< second moments of the places [d^2]
  Curvature curvature;
  double scatter;  ///< variance of the heights around it, relative to that by noise; at least 1
};

/// nullopt with too few tracks, or if they do not determine the quadratic.
std::optional<Surface> surface_of(const SolvedPlanes& solved, int plane, double sigma_px) {
  const std::vector<Height> heights = heights_of(solved, plane);
  if (heights.size() < kLeastHeights) return std::nullopt;
  const auto count = static_cast<double>(heights.size());
  const double distance = plane == 0 ? 1 : 1 / solved.motion.others[plane - 1].m.norm();
  Vector2d mean = Vector2d::Zero();
  for (const Height& one : heights) mean += one.place / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Eigen::Matrix<double, 6, 6> A = Eigen::Matrix<double, 6, 6>::Zero();
  Quadratic right = Quadratic::Zero();
  double squares = 0;
  for (const Height& one : heights) {
    const Vector2d p = one.place - mean;
    spread += p * p.transpose() / count;
    Quadratic q;
    q << 1, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
    const double information = one.information / (distance * distance);
    const double height = -one.gradient / one.information * distance;
    A += information * q * q.transpose();
    right += information * q * height;
    squares += information * height * height;
  }
  const Eigen::MatrixXd inverse = inverse_of_symmetric(A);
  const Quadratic fit = inverse * right;
  if (!fit.allFinite()) return std::nullopt;
  const double noise = sigma_px * sigma_px * (count - 6);
  return Surface{mean,
                 spread,
                 {fit.tail<3>(), inverse.bottomRightCorner<3, 3>().inverse()},
                 std::max(1.0, (squares - right.dot(fit)) / noise)};
}

/// The problem with free rotations, linearized at the solution, and its gradient.
struct FreeMotion {
  Bread bread;
  SharedMatrix inverse;  ///< inverse of the information about the shared unknowns
  std::vector<OwnVector> own_gradients;
  Eigen::VectorXd shared_gradient;  ///< with the frames' own unknowns eliminated
};

/// nullopt if the tracks do not determine the free rotations.
std::optional<FreeMotion> free_motion(const SolvedPlanes& solved) {
  const int planes = solved.observations.plane_count();
  const int frames = solved.frame_count();
  // With the weights of the least squares: the curvature of Huber's loss would exaggerate the step.
  Linearization linearized{
      std::vector<std::vector<FrameNormals>>(planes, std::vector<FrameNormals>(frames)), 1};
  for (int k = 0; k < planes; ++k) {
    for (int i = 1; i < frames; ++i) {
      const FrameState state = frame_state(solved.observations, solved.motion, i, k);
      FrameNormals& normals = linearized.planes[k][i];
      normals = weighted_normals(solved.observations.plane(k)[i], state, Rotating::yes);
      if (!normals.in_front) return std::nullopt;
    }
  }
  FreeMotion free;
  free.bread = bread_of(solved, linearized, RotationModel::free);
  const auto inverse = inverse_information(free.bread.information);
  if (!inverse) return std::nullopt;
  free.inverse = *inverse;
  free.shared_gradient = reduced_gradient(linearized, free.bread);
  free.own_gradients.assign(frames, OwnVector::Zero(6));
  for (const auto& plane : linearized.planes)
    for (int i = 1; i < frames; ++i) free.own_gradients[i] += plane[i].Jtr.tail<6>();
  return free;
}

/// Normal equations of a curvature over one frame.
struct FrameCurvature {
  Eigen::Matrix<double, 8, 3> cross = Eigen::Matrix<double, 8, 3>::Zero();  ///< with (u, phi, t)
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
};

FrameCurvature frame_curvature(const SolvedPlanes& solved,
                               int frame,
                               int plane,
                               const Vector2d& center) {
  const Vector3d m = plane == 0 ? solved.motion.normal : solved.motion.others[plane - 1].m;
  const auto tangents = normal_tangents(m.normalized());
  const FrameObservations& f = solved.observations.plane(plane)[frame];
  const FrameState state = frame_state(solved.observations, solved.motion, frame, plane);
  FrameCurvature sums;
  for (int k = 0; k < f.count; ++k) {
    const Transfer transfer = transfer_of(f, state, k);
    const Vector2d p = tangents.transpose() * transfer.ray_1 / -transfer.height - center;
    const Vector3d q(p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
    const Vector2d by_height = transfer.d_normal() * m * m.norm();
    const Vector2d error = transfer.pixel - Vector2d(f.u[k], f.v[k]);
    const Vector2d weighted = weight_of(f, k) * by_height;
    sums.cross += transfer.jacobian(state.tangents).transpose() * weighted * q.transpose();
    sums.information += by_height.dot(weighted) * q * q.transpose();
    sums.gradient += error.dot(weighted) * q;
  }
  return sums;
}

/// Estimates the curvatures of all planes together with their normals and a free motion, which
/// would otherwise have absorbed most of a bend. `surfaces` is null for a plane taken as flat.
std::vector<Curvature> curvatures_with_motion(const SolvedPlanes& solved,
                                              const FreeMotion& free,
                                              const std::vector<std::optional<Surface>>& surfaces) {
  const auto size = 3 * std::ssize(surfaces);
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(free.bread.layout.size(), size);
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
  for (int i = 1; i < solved.frame_count(); ++i) {
    const auto& [inverse, gain] = free.bread.frames[i];
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(6, size);
    for (int k = 0; k < std::ssize(surfaces); ++k) {
      if (!surfaces[k]) continue;
      const Eigen::Index at = Eigen::Index{3} * k;
      const FrameCurvature frame = frame_curvature(solved, i, k, surfaces[k]->center);
      cross(free.bread.places(k), Eigen::seqN(at, 3)) +=
          free.bread.columns[k][i].transpose() * frame.cross;
      information.block<3, 3>(at, at) += frame.information;
      gradient.segment<3>(at) += frame.gradient;
      own.middleCols<3>(at) = frame.cross.bottomRows<6>();
    }
    cross -= gain.transpose() * own;
    information -= own.transpose() * inverse * own;
    gradient -= own.transpose() * inverse * free.own_gradients[i];
  }
  information -= cross.transpose() * free.inverse * cross;
  gradient -= cross.transpose() * free.inverse * free.shared_gradient;
  for (Eigen::Index k = 0; k < std::ssize(surfaces); ++k)
    if (!surfaces[k]) information.block<3, 3>(3 * k, 3 * k).setIdentity();
  const auto covariance = inverse_information(information);
  std::vector<Curvature> curvatures(surfaces.size(), {Vector3d::Zero(), Eigen::Matrix3d::Zero()});
  if (!covariance) return curvatures;
  const Eigen::VectorXd values = -(*covariance * gradient);
  for (Eigen::Index k = 0; k < std::ssize(surfaces); ++k)
    curvatures[k] = {values.segment<3>(3 * k), covariance->block<3, 3>(3 * k, 3 * k).inverse()};
  return curvatures;
}

}  // namespace

std::vector<std::optional<Eigen::Matrix2d>> bends_of(const SolvedPlanes& solved, double sigma_px) {
  std::vector<std::optional<Eigen::Matrix2d>> bends(solved.observations.plane_count());
  if (!(sigma_px > 0)) return bends;
  std::vector<std::optional<Surface>> surfaces;
  for (int k = 0; k < std::ssize(bends); ++k) surfaces.push_back(surface_of(solved, k, sigma_px));
  // A gyroscope limits how far the motion can absorb a bend.
  std::vector<Curvature> with_motion;
  if (!solved.window.gyro)
    if (const auto free = free_motion(solved))
      with_motion = curvatures_with_motion(solved, *free, surfaces);
  for (std::size_t k = 0; k < bends.size(); ++k) {
    if (!surfaces[k]) continue;
    const Curvature& bend = with_motion.empty() ? surfaces[k]->curvature : with_motion[k];
    const double noise_px2 = sigma_px * sigma_px * surfaces[k]->scatter;
    if (!(bend.value.dot(bend.information * bend.value) > kLeastBend * noise_px2)) continue;
    Eigen::Matrix2d slope;
    slope << 2 * bend.value(0), bend.value(1), bend.value(1), 2 * bend.value(2);
    bends[k] = slope * surfaces[k]->spread * slope;
  }
  return bends;
}

void widen_by_systematic_errors(const SolvedPlanes& solved,
                                double ratio,
                                const SharedMoves& shared,
                                Uncertainty& u) {
  const auto& [Y, K] = shared;
  const int gyro = static_cast<int>(Y.rows() - 2 - 3 * std::ssize(u.others));
  if (!(ratio > 1)) return;
  // Information about an unknown with this prior, of which the images' share becomes smaller.
  const auto less = [&](double information, double prior_sigma) {
    return information / ratio + (1 - 1 / ratio) / (prior_sigma * prior_sigma);
  };
  if (u.row_delay_sigma_s) {
    const Window& window = solved.window;
    const double prior_s = window.row_delay.value_or(unknown_row_delay(window)).sigma_s;
    if (prior_s > 0)
      u.row_delay_sigma_s = 1 / std::sqrt(less(std::pow(*u.row_delay_sigma_s, -2), prior_s));
  }
  const auto information = inverse_information(Y);
  if (!information) return;
  SharedMatrix wide = *information / ratio;
  const GyroVector prior_sigmas = gyro_prior_sigmas(solved.window, gyro);
  for (int k = 0; k < gyro; ++k) wide(k, k) = less((*information)(k, k), prior_sigmas(k));
  const auto widened = inverse_information(wide);
  if (!widened) return;
  const SharedMatrix by_shared = *widened - Y;
  Eigen::MatrixXd of_poses = Eigen::MatrixXd::Zero(2 * (K.rows() - Y.rows()), Y.cols());
  for (int i = 1; i < solved.frame_count(); ++i) {
    const Eigen::Index center = 3 * (Eigen::Index{i} - 1);
    of_poses.block(2 * center, 0, 3, gyro) = gyro_columns(solved.window, solved.motion, i, gyro);
    of_poses.middleRows<3>(2 * center + 3) = K.middleRows<3>(center);
  }
  if (u.pose_covariance.size() > 0)
    u.pose_covariance += of_poses * by_shared * of_poses.transpose();
  add_to_marginals(solved.motion, K * by_shared * K.transpose(), u);
}

void add_bends(const SolvedPlanes& solved, Uncertainty& u) {
  const auto bends = bends_of(solved, u.sigma_px);
  const auto bend_along = [&](std::size_t plane, const Vector3d& normal) -> Eigen::Matrix3d {
    const auto N = normal_tangents(normal);
    return N * bends[plane].value_or(Eigen::Matrix2d::Zero()) * N.transpose();
  };
  const Eigen::Matrix3d of_main = bend_along(0, solved.motion.normal);
  if (of_main.trace() > 0) u.bend_sigma_deg = degrees(std::sqrt(of_main.trace()));
  const Eigen::Index size =
      u.joint_covariance.rows() - Eigen::Index{3} * (solved.frame_count() - 1);
  const SharedMatrix Y = u.joint_covariance.bottomRightCorner(size, size);
  if (const auto information = inverse_information(Y))
    widen_by_systematic_errors(solved,
                               1 + of_main.trace() / u.normal_covariance.trace(),
                               {Y, u.joint_covariance.rightCols(size) * *information},
                               u);
  set_normal_covariance(u.normal_covariance + of_main, u);
  for (std::size_t k = 0; k < u.others.size(); ++k)
    u.others[k].normal_covariance += bend_along(k + 1, solved.motion.others[k].m.normalized());
}

}  // namespace gpo
