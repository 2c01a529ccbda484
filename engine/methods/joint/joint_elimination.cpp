// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Eliminates the latent positions, and substitutes them back into a step.
#include "engine/methods/joint/joint_model.h"

#include <algorithm>

#include <Eigen/Cholesky>

namespace gpo::joint {

using Eigen::Index;
using Eigen::Matrix2d;
using Eigen::Vector2d;
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
