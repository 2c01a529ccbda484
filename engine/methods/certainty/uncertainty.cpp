// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/certainty/uncertainty.h"

#include "engine/methods/certainty/bend.h"
#include "engine/methods/certainty/joint_centers.h"
#include "engine/methods/certainty/neighbors.h"
#include "engine/methods/certainty/sandwich.h"
#include "engine/methods/certainty/shared_information.h"
#include "engine/methods/certainty/solution_moves.h"
#include "engine/methods/common/window_checks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

int tracks_of(const PlaneObservations& observations) {
  std::set<int> tracks;
  for (int k = 0; k <= static_cast<int>(observations.others.size()); ++k)
    for (const FrameObservations& f : of_plane(observations, k))
      tracks.insert(f.track.begin(), f.track.end());
  return static_cast<int>(tracks.size());
}

/// Covariances of a frame's camera center and of its distance ratio 1 - n.tau.
void add_frame(const PlaneMotion& motion,
               int frame,
               const Eliminated& f,
               const Spread& spread,
               Uncertainty& result) {
  const SharedMatrix& Y = spread.shared;
  const Eigen::MatrixXd cross = -Y * f.gain.transpose() + spread.cross[frame];
  const Eigen::MatrixXd gained = f.gain * spread.cross[frame];
  const Eigen::MatrixXd own =
      f.gain * Y * f.gain.transpose() - gained - gained.transpose() + spread.own[frame];
  const Matrix3d t = own.bottomRightCorner<3, 3>();
  const Eigen::Matrix<double, 2, 3> ut = cross.topRightCorner<2, 3>();
  const Matrix3d& R = motion.R_wc[frame];
  result.center_covariances.emplace_back(R * t * R.transpose());
  const Eigen::Vector2d d_u = -(normal_tangents(motion.normal).transpose() * motion.tau[frame]);
  const Vector3d d_t = -(R.transpose() * motion.normal);
  const double ratio_variance =
      d_u.dot(Y.topLeftCorner<2, 2>() * d_u) + 2 * d_u.dot(ut * d_t) + d_t.dot(t * d_t);
  result.distance_ratio_sigmas.push_back(std::sqrt(std::max(0.0, ratio_variance)));
}

/// The inverse information of what is unknown; of a bias that is held, only the rest's.
std::optional<SharedMatrix> shared_inverse_of(const Bread& bread, bool holds_bias) {
  const int size = bread.layout.size();
  const int unknown = holds_bias ? size - 3 : size;
  const auto inverse = inverse_information(bread.information.topLeftCorner(unknown, unknown));
  if (!inverse) return std::nullopt;
  SharedMatrix all = SharedMatrix::Zero(size, size);
  all.topLeftCorner(unknown, unknown) = *inverse;
  return all;
}

/// What is not known of the bias, beside the pictures' noise: the prior, where it is estimated; an
/// error db of one that is held moves the rest by -A_uu^-1 A_ub db.
SharedMatrix bias_share(const Window& window,
                        const Bread& bread,
                        const SharedMatrix& shared_inverse,
                        double sigma_px,
                        bool holds_bias) {
  const int size = bread.layout.size();
  if (bread.layout.gyro == 0) return SharedMatrix::Zero(size, size);
  if (!holds_bias)
    return sigma_px * sigma_px * shared_inverse * bread.prior * shared_inverse.transpose();
  SharedMatrix moves = -shared_inverse * bread.information.rightCols(3);
  moves.bottomRows<3>().setIdentity();
  return moves * window.gyro->bias_covariance * moves.transpose();
}

/// Cramer-Rao bound of the normal's angle under independent noise [deg].
std::optional<double> bound_deg(const Window& window,
                                const PlaneMotion& motion,
                                const Linearization& linearized,
                                RotationModel model) {
  const Bread plain = bread_of(window, motion, linearized, model);
  return normal_sigma_deg(plain.information, linearized.sigma_px);
}

/// All that is wrong and moves single frames, too.
std::vector<SolutionMove> all_moves(const Window& window,
                                    const PlaneObservations& observations,
                                    const PlaneMotion& motion,
                                    const Bread& bread,
                                    const SharedMatrix& shared_inverse,
                                    double degrees_of_freedom) {
  std::vector<SolutionMove> moves =
      moves_by_track(window, observations, motion, bread, shared_inverse, degrees_of_freedom);
  std::ranges::move(moves_by_gyro_noise(window, motion, bread, shared_inverse),
                    std::back_inserter(moves));
  for (std::size_t p = 0; p < window.lens_moves_px.size(); ++p)
    moves.push_back(move_by_lens(window, observations, motion, bread, shared_inverse, p));
  return moves;
}

using OfPlanes = std::vector<std::optional<Eigen::Matrix2d>>;

/// What neighboring tracks have wrong together, of each plane's normal, beyond its share of `flat`.
OfPlanes beyond(OfPlanes neighbors, const SharedMatrix& flat) {
  for (std::size_t k = 0; k < neighbors.size(); ++k) {
    const int at = UnknownsLayout::of_plane(static_cast<int>(k));
    if (neighbors[k]) *neighbors[k] -= flat.block<2, 2>(at, at);
  }
  return neighbors;
}

/// Covariances of all planes' normals and distances: what noise leaves, what neighbors share, and
/// how the planes bend. A bias that is held is wrong and bends what is flat; it has its own share
/// already.
void add_planes(const PlaneObservations& observations,
                const PlaneMotion& motion,
                const SharedMatrix& covariance,
                const OfPlanes& neighbors,
                bool holds_bias,
                Uncertainty& result) {
  const auto bent = [&](const Eigen::Matrix2d& flat, int plane) -> Eigen::Matrix2d {
    if (holds_bias) return flat;
    if (neighbors[plane] && plane == 0)
      result.neighbors_sigma_deg = degrees(std::sqrt(neighbors[plane]->trace()));
    const Eigen::Matrix2d all = flat + neighbors[plane].value_or(Eigen::Matrix2d::Zero());
    const auto bend = bend_of(observations, motion, plane, result.sigma_px);
    if (bend && plane == 0) result.bend_sigma_deg = degrees(std::sqrt(bend->trace()));
    return bend ? Eigen::Matrix2d(all + *bend) : all;
  };
  const auto tangents = normal_tangents(motion.normal);
  result.normal_covariance =
      tangents * bent(covariance.topLeftCorner<2, 2>(), 0) * tangents.transpose();
  result.normal_sigma_deg = degrees(std::sqrt(result.normal_covariance.trace()));
  for (std::size_t k = 0; k < motion.others.size(); ++k) {
    const int at = UnknownsLayout::of_plane(static_cast<int>(k) + 1);
    const auto N = normal_tangents(motion.others[k].m.normalized());
    const Eigen::Matrix2d of_normal = bent(covariance.block<2, 2>(at, at), static_cast<int>(k) + 1);
    result.others.push_back(
        {N * of_normal * N.transpose(), std::sqrt(std::max(0.0, covariance(at + 2, at + 2)))});
  }
}

}  // namespace

std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const PlaneObservations& observations,
                                          const PlaneMotion& motion,
                                          RotationModel model,
                                          Centers centers) {
  const auto linearized = linearize(observations, motion, model);
  if (!linearized) return std::nullopt;
  const bool holds_bias = model == RotationModel::known && window.gyro;
  const RotationModel moving = holds_bias ? RotationModel::bias : model;
  const Bread bread = bread_of(window, motion, *linearized, moving);
  const auto inverse = shared_inverse_of(bread, holds_bias);
  if (!inverse) return std::nullopt;
  const int frames = static_cast<int>(motion.tau.size());
  const double residuals = 2.0 * observations.count();
  const double unknowns = inverse->rows() + own_size(model, motion) * (frames - 1.0);
  const double degrees_of_freedom = residuals / std::max(1.0, residuals - unknowns);
  Spread spread = spread_of(window, observations, motion, bread, *inverse, degrees_of_freedom);
  OfPlanes neighbors(observations.others.size() + 1);
  if (!holds_bias)
    neighbors = beyond(
        neighbors_spread(window, observations, motion, model, linearized->sigma_px, spread.shared),
        spread.shared);
  const double without_lens = spread.shared.topLeftCorner<2, 2>().trace();
  add_lens(window, observations, motion, bread, *inverse, spread);
  const double of_lens = spread.shared.topLeftCorner<2, 2>().trace() - without_lens;
  add_gyro_noise(window, motion, bread, *inverse, spread);
  spread.shared += bias_share(window, bread, *inverse, linearized->sigma_px, holds_bias);
  const SharedMatrix& covariance = spread.shared;
  Uncertainty result;
  result.sigma_px = linearized->sigma_px;
  result.rotations = model;
  result.tracks = tracks_of(observations);
  if (!window.lens_moves_px.empty())
    result.lens_sigma_deg = degrees(std::sqrt(std::max(0.0, of_lens)));
  add_planes(observations, motion, covariance, neighbors, holds_bias, result);
  result.center_covariances.emplace_back(Matrix3d::Zero());
  result.distance_ratio_sigmas.push_back(0);
  for (int i = 1; i < frames; ++i) add_frame(motion, i, bread.frames[i], spread, result);
  if (centers == Centers::jointly) {
    const auto moves = all_moves(window, observations, motion, bread, *inverse, degrees_of_freedom);
    result.joint_covariance = joint_covariance(motion, bread, moves, covariance);
    result.joint_bias_rows = bread.layout.gyro > 0 ? 3 : 0;
  }
  if (model == RotationModel::bias) result.bias_covariance = covariance.bottomRightCorner<3, 3>();
  const auto bound = [&](RotationModel of) { return bound_deg(window, motion, *linearized, of); };
  result.bound_known_rotations_deg = bound(RotationModel::known);
  if (window.gyro) result.bound_unknown_bias_deg = bound(RotationModel::bias);
  return result;
}

std::optional<Uncertainty> uncertainty_of(const Window& window,
                                          const Plane& plane,
                                          std::span<const Pose> cameras,
                                          RotationModel model,
                                          Centers centers) {
  return uncertainty_of(
      window, plane_observations(window), motion_of(plane, cameras), model, centers);
}

}  // namespace gpo
