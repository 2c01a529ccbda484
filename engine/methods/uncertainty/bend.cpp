// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/bend.h"

#include "engine/geometry/decompositions.h"
#include "engine/methods/plane/plane_weights.h"
#include "engine/methods/uncertainty/information.h"

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
  Vector2d place = {};     ///< along the plane's tangents [d]
  double gradient = 0;     ///< gradient of the cost over the log of the distance [px^2]
  double information = 0;  ///< [px^2]
};

std::vector<Height> heights_of(const SolvedPlanes& solved) {
  const Vector3d& n = solved.motion.normal;
  const auto tangents = normal_tangents(n);
  std::vector<Height> heights(solved.window.track_count());
  for (int i = 1; i < solved.frame_count(); ++i) {
    const FrameObservations& f = solved.observations.frames[i];
    const FrameState state = frame_state(solved.observations, solved.motion, i);
    for (int k = 0; k < f.count; ++k) {
      const Transfer transfer = transfer_of(f, state, k);
      const Vector2d dp = transfer.d_normal() * n;
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
std::optional<Surface> surface_of(const SolvedPlanes& solved, double sigma_px) {
  const std::vector<Height> heights = heights_of(solved);
  if (heights.size() < kLeastHeights) return std::nullopt;
  const auto count = static_cast<double>(heights.size());
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
    const double height = -one.gradient / one.information;
    A += one.information * q * q.transpose();
    right += one.information * q * height;
    squares += one.information * height * height;
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

FrameCurvature frame_curvature(const SolvedPlanes& solved, int frame, const Vector2d& center) {
  const Vector3d& n = solved.motion.normal;
  const auto tangents = normal_tangents(n);
  const FrameObservations& f = solved.observations.frames[frame];
  const FrameState state = frame_state(solved.observations, solved.motion, frame);
  FrameCurvature sums;
  for (int k = 0; k < f.count; ++k) {
    const Transfer transfer = transfer_of(f, state, k);
    const Vector2d p = tangents.transpose() * transfer.ray_1 / -transfer.height - center;
    const Vector3d q(p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
    const Vector2d by_height = transfer.d_normal() * n;
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
/// Returns one Gauss-Newton step of the curvature together with the motion; nullopt if that does
/// not determine it.
std::optional<Curvature> curvature_with_motion(const SolvedPlanes& solved,
                                               const FreeMotion& free,
                                               const Vector2d& center) {
  Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(free.bread.layout.size(), 3);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Vector3d gradient = Vector3d::Zero();
  for (int i = 1; i < solved.frame_count(); ++i) {
    const auto& [inverse, gain] = free.bread.frames[i];
    const FrameCurvature frame = frame_curvature(solved, i, center);
    const Eigen::Matrix<double, 6, 3> own = frame.cross.bottomRows<6>();
    cross(free.bread.places(0), Eigen::all) += free.bread.columns[0][i].transpose() * frame.cross;
    cross -= gain.transpose() * own;
    information += frame.information - own.transpose() * inverse * own;
    gradient += frame.gradient - own.transpose() * inverse * free.own_gradients[i];
  }
  information -= cross.transpose() * free.inverse * cross;
  gradient -= cross.transpose() * free.inverse * free.shared_gradient;
  const auto covariance = inverse_information(information);
  if (!covariance) return std::nullopt;
  return Curvature{-(*covariance * gradient), information};
}

}  // namespace

std::optional<double> bend_sigma_deg(const SolvedPlanes& solved, double sigma_px) {
  const auto surface = sigma_px > 0 ? surface_of(solved, sigma_px) : std::nullopt;
  if (!surface) return std::nullopt;
  Curvature bend = surface->curvature;
  // A gyroscope limits how far the motion can absorb a bend.
  if (const auto free = solved.window.gyro ? std::nullopt : free_motion(solved)) {
    const auto with_motion = curvature_with_motion(solved, *free, surface->center);
    if (!with_motion) return std::nullopt;
    bend = *with_motion;
  }
  const double noise_px2 = sigma_px * sigma_px * surface->scatter;
  if (!(bend.value.dot(bend.information * bend.value) > kLeastBend * noise_px2))
    return std::nullopt;
  Eigen::Matrix2d slope;
  slope << 2 * bend.value(0), bend.value(1), bend.value(1), 2 * bend.value(2);
  return degrees(std::sqrt((slope * surface->spread * slope).trace()));
}

}  // namespace gpo
