// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Eliminates the latent positions, and substitutes them back into a step.
#include "engine/geometry/pose.h"
#include "engine/methods/joint/joint_model.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

namespace gpo::joint {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

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
  PlaneMotion& motion = to.motion;
  motion.normal = moved_normal(motion.normal, x.head<2>());
  for (int k = 1; k < layout_.planes; ++k) {
    Vector3d& m = motion.others[k - 1].m;
    const Vector3d u_s = x.segment<3>(UnknownsLayout::of_plane(k));
    const double length = m.norm();
    m = length * std::exp(u_s(2)) * moved_normal(m / length, u_s.head<2>());
  }
  const Index gyro = layout_.shared.of_gyro();
  if (layout_.shared.gyro > 0) motion.bias_rad_s += x.segment<3>(gyro);
  if (layout_.shared.gyro == 4) motion.time_offset_s += x(gyro + 3);
  if (layout_.row_delay > 0) to.row_delay_s += x(layout_.at_row_delay());
  if (layout_.lens > 0) to.lens += x.segment<kLensTerms>(layout_.at_lens());
  for (int i = 1; i < layout_.frames; ++i) {
    motion.tau[i] += from.motion.R_wc[i] * x.segment<3>(layout_.at_translation(i));
    if (layout_.own == 6) {
      const Matrix3d turn = so3_exp(x.segment<3>(layout_.at_frame(i)));
      if (options_.gyro_noise)
        motion.gyro_noise_rad[i] = so3_log(so3_exp(motion.gyro_noise_rad[i]) * turn);
      else
        motion.R_wc[i] = motion.R_wc[i] * turn;
    }
    if (layout_.shared.gyro > 0) motion.R_wc[i] = gyro_rotation(window_, i, motion);
  }
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
