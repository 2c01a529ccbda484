// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Adds the priors, eliminates the latent positions, and substitutes them back into a step.
#include "engine/methods/joint/joint_model.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace gpo::joint {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Standard deviation of a part that is absent or held.
constexpr double kHeld = 1e-6;

// The steps of the random walk, in the axes of the world, are independent.
MatrixXd Model::walk_information(const PlaneMotion& start) const {
  const Index size = Index{3} * (layout_.frames - 1);
  MatrixXd information = MatrixXd::Zero(size, size);
  for (int i = 1; i < layout_.frames; ++i) {
    const double after = gyro_noise_sigma_rad(window_, i);
    const double before = gyro_noise_sigma_rad(window_, i - 1);
    const double weight = 1 / std::max(after * after - before * before, 1e-20);
    const Index b = Index{3} * (i - 1), a = b - 3;
    information.block<3, 3>(b, b).diagonal().array() += weight;
    if (i == 1) continue;
    const Matrix3d R = start.R_wc[i].transpose() * start.R_wc[i - 1];
    information.block<3, 3>(a, a).diagonal().array() += weight;
    information.block<3, 3>(b, a) -= weight * R;
    information.block<3, 3>(a, b) -= weight * R.transpose();
  }
  return information;
}

Priors Model::priors(const State& state, const Scales& scales, Priors all) const {
  const Index size = layout_.size();
  all.information.setZero(size, size);
  all.gradient.setZero(size);
  all.cost = 0;
  const double variance = scales.sigma_px * scales.sigma_px;
  const auto add = [&](Index at, double sigma, double error) {
    const double weight = variance / (sigma * sigma);
    all.information(at, at) += weight;
    all.gradient(at) += weight * error;
    all.cost += 0.5 * weight * error * error;
  };
  const PlaneMotion& motion = state.motion;
  const GyroVector sigmas = gyro_prior_sigmas(window_, layout_.shared.gyro);
  const GyroVector errors = gyro_prior_errors(window_, layout_.shared.gyro, motion);
  for (int k = 0; k < layout_.shared.gyro; ++k)
    add(layout_.shared.of_gyro() + k, sigmas(k), errors(k));
  if (layout_.row_delay > 0)
    add(layout_.at_row_delay(),
        options_.row_delay->sigma_s,
        state.row_delay_s - options_.row_delay->mean_s);
  for (int p = 0; p < layout_.lens_parameters; ++p) add(layout_.at_parameters() + p, kHeld, 0);
  for (int k = 0; k < layout_.lens; ++k)
    add(layout_.at_lens() + k, std::max(kHeld, scales.lens_px), state.lens(k));
  for (int i = 0; layout_.velocity > 0 && i < layout_.frames; ++i) {
    for (int k = 0; k < layout_.velocity; ++k) {
      const Velocity& velocity = state.velocities[i];
      const double sigma = k < 3 ? velocity.tau_sigma_s : velocity.rotation_sigma_rad_s;
      add(layout_.at_velocity(i) + k, std::max(kHeld, sigma), 0);
    }
  }
  for (int i = 1; options_.gyro_noise && i < layout_.frames; ++i) {
    for (int k = std::max(1, i - 1); k < std::min(layout_.frames, i + 2); ++k) {
      const Matrix3d weight = variance * walk_.block<3, 3>(Index{3} * (i - 1), Index{3} * (k - 1));
      const Vector3d pull = weight * motion.gyro_noise_rad[k];
      all.information.block<3, 3>(layout_.at_frame(i), layout_.at_frame(k)) += weight;
      all.gradient.segment<3>(layout_.at_frame(i)) += pull;
      all.cost += 0.5 * motion.gyro_noise_rad[i].dot(pull);
    }
  }
  return all;
}

void Model::eliminate_latent_positions(Normals& all) const {
  const Index count = std::ssize(tracks_);
  for (Index j = 0; j < count; ++j) {
    if (!(all.V[j].trace() > 0)) all.V[j].setIdentity();  // all observations are beyond the gate
    const Eigen::LLT<Matrix2d> factor(all.V[j]);
    const Matrix2d L = factor.matrixL();
    factor.matrixL().solveInPlace(all.v[j]);
    for (Index row = 0; row < layout_.size(); row += kPanel) {
      auto pair = all.half.middleCols<2>(row / kPanel * 2 * count + 2 * j);
      pair.col(0) /= L(0, 0);
      pair.col(1) = (pair.col(1) - L(1, 0) * pair.col(0)) / L(1, 1);
      const Eigen::Matrix<double, kPanel, 1> part = pair * all.v[j];
      const Index rows = std::min<Index>(kPanel, layout_.size() - row);
      all.gradient.segment(row, rows) -= part.head(rows);
      if (all.by_track.size() > 0) all.by_track.col(j).segment(row, rows) -= part.head(rows);
    }
  }
  subtract_self_product(all.half, all.A);
  all.A.triangularView<Eigen::StrictlyUpper>() = all.A.transpose();
}

State Model::moved(const State& from, const VectorXd& x, const Normals& at) const {
  State to = from;
  move_shared(layout_.shared, x.head(layout_.shared.size()), to.motion);
  if (layout_.row_delay > 0) to.row_delay_s += x(layout_.at_row_delay());
  if (layout_.lens > 0) to.lens += x.segment<kLensTerms>(layout_.at_lens());
  for (int i = 1; i < layout_.frames; ++i)
    move_frame(
        window_, layout_.shared.gyro, i, x.segment(layout_.at_frame(i), layout_.own), to.motion);
  const Index count = std::ssize(tracks_);
  for (Index j = 0; j < count; ++j) {
    Vector2d pull = at.v[j];
    for (Index row = 0; row < x.size(); row += kPanel) {
      const Index rows = std::min<Index>(kPanel, x.size() - row);
      pull += at.half.middleCols<2>(row / kPanel * 2 * count + 2 * j).topRows(rows).transpose() *
              x.segment(row, rows);
    }
    to.shift_px.col(j) -= Eigen::LLT<Matrix2d>(at.V[j]).matrixU().solve(pull);
  }
  return to;
}

}  // namespace gpo::joint
