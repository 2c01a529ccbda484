// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/joint/joint_uncertainty.h"

#include "engine/methods/uncertainty/information.h"
#include "engine/methods/uncertainty/shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include <Eigen/Cholesky>

namespace gpo::joint {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;

/// The unknowns that results depend on: those that all frames share, the row delay, and all
/// translations from here on.
Index first_translation(const JointLayout& layout) {
  return layout.at_row_delay() + layout.row_delay;
}

/// The rotations of the frames follow if they are unknowns.
std::vector<Index> unknowns_of_results(const JointLayout& layout) {
  std::vector<Index> unknowns(first_translation(layout));
  std::iota(unknowns.begin(), unknowns.end(), 0);
  for (int i = 1; i < layout.frames; ++i)
    for (int axis = 0; axis < 3; ++axis) unknowns.push_back(layout.at_translation(i) + axis);
  for (int i = 1; layout.own == 6 && i < layout.frames; ++i)
    for (int axis = 0; axis < 3; ++axis) unknowns.push_back(layout.at_frame(i) + axis);
  return unknowns;
}

/// Returns the numbers of unknowns that belong together, in the order of `unknowns_of_results`.
std::vector<int> blocks_of_results(const JointLayout& layout) {
  std::vector<int> sizes;
  layout.shared.add_plane_sizes(sizes);
  if (layout.shared.gyro > 0) sizes.push_back(3);
  if (layout.shared.gyro > 3) sizes.push_back(1);  // the time offset
  if (layout.row_delay > 0) sizes.push_back(1);
  sizes.insert(sizes.end(), (layout.own / 3) * (layout.frames - 1), 3);
  return sizes;
}

/// Returns D M, D = d(rotation, center) / d(unknowns of results) of all cameras but the first.
MatrixXd moves_of_poses(const Model& model, const PlaneMotion& motion, const MatrixXd& M) {
  const JointLayout& layout = model.layout();
  const Index translations = first_translation(layout);
  const Index rotations = translations + 3 * (layout.frames - 1);
  MatrixXd moves = MatrixXd::Zero(6 * (layout.frames - 1), M.cols());
  for (int i = 1; i < layout.frames; ++i) {
    const Index own = 3 * (i - 1);
    auto rotation = moves.middleRows<3>(2 * own);
    if (const int gyro = layout.shared.gyro; gyro > 0)
      rotation = gyro_columns(model.window(), motion, i, gyro) *
                 M.middleRows(layout.shared.of_gyro(), gyro);
    if (layout.own == 6) rotation += M.middleRows<3>(rotations + own);
    moves.middleRows<3>(2 * own + 3) = -motion.R_wc[i] * M.middleRows<3>(translations + own);
  }
  return moves;
}

/// Returns D M, D = d(centers without the first, gyroscope, planes) / d(unknowns of results).
MatrixXd moves_of_results(const JointLayout& layout, const PlaneMotion& motion, MatrixXd M) {
  const Index translations = first_translation(layout);
  std::vector<Index> order;
  for (int i = 1; i < layout.frames; ++i) {
    const Index at = translations + 3 * (i - 1);
    M.middleRows<3>(at) = (-motion.R_wc[i] * M.middleRows<3>(at)).eval();
    for (int axis = 0; axis < 3; ++axis) order.push_back(at + axis);
  }
  for (int k = 0; k < layout.shared.gyro; ++k) order.push_back(layout.shared.of_gyro() + k);
  for (int k = 0; k < layout.shared.of_gyro(); ++k) order.push_back(k);
  return M(order, Eigen::all);
}

/// Returns gain^T prior gain.
MatrixXd spread_of_priors(const MatrixXd& prior, const MatrixXd& gain) {
  std::vector<Index> held;
  for (Index k = 0; k < prior.rows(); ++k)
    if (prior(k, k) > 0) held.push_back(k);
  const MatrixXd of_held = gain(held, Eigen::all);
  return of_held.transpose() * (prior(held, held) * of_held);
}

/// Returns the Cramér-Rao bound of the normal [deg] with unknown normal, translations and, on
/// request, bias.
std::optional<double> bound_deg(const JointLayout& layout,
                                const Normals& at,
                                const MatrixXd* prior_of_bias,
                                double sigma_px) {
  std::vector<Index> unknown{0, 1};
  for (int k = 0; prior_of_bias && k < layout.shared.gyro; ++k)
    unknown.push_back(layout.shared.of_gyro() + k);
  for (int i = 1; i < layout.frames; ++i)
    for (int axis = 0; axis < 3; ++axis) unknown.push_back(layout.at_translation(i) + axis);
  // The robust loss uses less of the information than there is.
  MatrixXd information = at.A(unknown, unknown) / at.curvature;
  if (prior_of_bias) information += (*prior_of_bias)(unknown, unknown);
  const Eigen::LLT<MatrixXd> factor(information);
  if (factor.info() != Eigen::Success) return std::nullopt;
  const MatrixXd columns = factor.solve(MatrixXd::Identity(std::ssize(unknown), 2));
  return degrees(sigma_px * std::sqrt(columns.topRows<2>().trace()));
}

void add_planes(const JointLayout& layout,
                const PlaneMotion& motion,
                const MatrixXd& covariance,
                Uncertainty& result) {
  const auto of_normal = [&](const Vector3d& normal, int plane) -> Matrix3d {
    const auto N = normal_tangents(normal);
    const Index at = UnknownsLayout::of_plane(plane);
    return N * covariance.block<2, 2>(at, at) * N.transpose();
  };
  result.normal_covariance = of_normal(motion.normal, 0);
  result.normal_sigma_deg = degrees(std::sqrt(result.normal_covariance.trace()));
  for (int k = 1; k < layout.planes; ++k)
    result.others.push_back({of_normal(motion.others[k - 1].m.normalized(), k)});
}

/// Returns the part of the normal's standard deviation that the lens residual contributes [deg].
double residual_part_deg(const JointLayout& layout, const MatrixXd& gain, const Scales& scales) {
  if (!(scales.lens_px > 0)) return 0;
  const double ratio = scales.sigma_px / scales.lens_px;
  return degrees(scales.sigma_px * ratio * gain.block(layout.at_lens(), 0, layout.lens, 2).norm());
}

/// Returns the moves of the results by one standard deviation of each lens parameter.
MatrixXd moves_by_lens(const JointLayout& layout, const MatrixXd& A, const MatrixXd& gain) {
  const auto parameters = Eigen::seqN(layout.at_parameters(), layout.lens_parameters);
  MatrixXd gradient = A(Eigen::all, parameters);
  gradient(parameters, Eigen::all).setZero();
  return gain.transpose() * gradient;
}

void add_lens_parts(const JointLayout& layout,
                    double residual_deg,
                    const MatrixXd& by_lens,
                    Uncertainty& result) {
  const double variance = by_lens.topRows<2>().squaredNorm();
  if (layout.typical_lens) {
    result.typical_lens_sigma_deg = degrees(std::sqrt(result.normal_covariance.trace() + variance));
    if (residual_deg > 0) result.lens_sigma_deg = residual_deg;
  } else {
    result.lens_sigma_deg = std::hypot(residual_deg, degrees(std::sqrt(variance)));
  }
}

}  // namespace

Uncertainty uncertainty_of(const Model& model,
                           const State& state,
                           const Normals& at,
                           const Scales& scales) {
  const JointLayout& layout = model.layout();
  const double variance = scales.sigma_px * scales.sigma_px;
  const MatrixXd prior = model.priors(state, scales).information;
  const std::vector<Index> wanted = unknowns_of_results(layout);
  MatrixXd gain = MatrixXd::Zero(layout.size(), std::ssize(wanted));
  for (Index k = 0; k < gain.cols(); ++k) gain(wanted[k], k) = 1;
  Eigen::LLT<MatrixXd>(at.A + prior).solveInPlace(gain);
  const auto tracks = static_cast<double>(model.tracks().size());
  const double residuals = 2.0 * model.observation_count();
  const double unknowns = layout.at_velocity(0) - layout.lens - layout.lens_parameters;
  const double freedom = residuals / std::max(1.0, residuals - unknowns);
  const MatrixXd moves =
      std::sqrt(freedom * tracks / std::max(1.0, tracks - 1)) * (gain.transpose() * at.by_track);
  const MatrixXd of_priors = variance * spread_of_priors(prior, gain);
  const MatrixXd by_lens = moves_by_lens(layout, at.A, gain);
  const MatrixXd independent = variance * gain(wanted, Eigen::all) - of_priors;
  const MatrixXd square = square_of(moves);
  const MatrixXd of_noise = with_blocks_of(
      square, blocks_of_results(layout), shrunk_covariance(moves, square, independent));
  MatrixXd covariance = of_priors + of_noise;
  if (!layout.typical_lens) covariance += by_lens * by_lens.transpose();

  Uncertainty result;
  result.sigma_px = scales.sigma_px;
  result.tracks = static_cast<int>(model.tracks().size());
  result.rotations = model.options().rotations;
  add_planes(layout, state.motion, covariance, result);
  const auto covariance_of_results = [&](const MatrixXd& of_unknowns) -> MatrixXd {
    return moves_of_results(
        layout, state.motion, moves_of_results(layout, state.motion, of_unknowns).transpose());
  };
  result.joint_covariance = covariance_of_results(covariance);
  result.noise = noise_spread(state.motion, covariance_of_results(of_noise), result);
  result.pose_covariance = moves_of_poses(
      model, state.motion, moves_of_poses(model, state.motion, covariance).transpose());
  result.center_covariances.assign(layout.frames, Matrix3d::Zero());
  result.distance_ratio_sigmas.assign(layout.frames, 0);
  result.joint_bias_rows = layout.shared.gyro;
  if (layout.shared.gyro > 0) result.bias_covariance = Matrix3d::Zero();
  if (layout.shared.gyro > 3) result.time_offset_sigma_s = 0;
  add_to_marginals(state.motion, result.joint_covariance, result);
  if (layout.shared.gyro > 0)
    result.bound_unknown_bias_deg = bound_deg(layout, at, &prior, scales.sigma_px);
  result.bound_known_rotations_deg = bound_deg(layout, at, nullptr, scales.sigma_px);
  if (layout.row_delay > 0)
    result.row_delay_sigma_s = std::sqrt(covariance(layout.at_row_delay(), layout.at_row_delay()));
  add_lens_parts(layout, residual_part_deg(layout, gain, scales), by_lens, result);
  if (!layout.typical_lens) return result;
  result.typical_lens_moves = {moves_of_results(layout, state.motion, by_lens),
                               moves_of_poses(model, state.motion, by_lens),
                               by_lens.middleRows(layout.at_row_delay(), layout.row_delay)};
  return result;
}

}  // namespace gpo::joint
