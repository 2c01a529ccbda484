// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo::joint {

/// Rows of a matrix in panels of eight, one panel with all columns after the other; the last one is
/// padded by zeros.
inline constexpr Eigen::Index kPanel = 8;
using Panels = Eigen::Matrix<double, kPanel, Eigen::Dynamic>;

inline Eigen::Index panel_count(Eigen::Index rows) { return (rows + kPanel - 1) / kPanel; }
/// Returns the place of a row's first element in panels with `columns` columns.
inline Eigen::Index place_in_panel(Eigen::Index row, Eigen::Index columns) {
  return row / kPanel * kPanel * columns + row % kPanel;
}

/// Subtracts H H^T from the lower triangle of A, with the widest instructions of the processor:
/// more than half of the joint model's arithmetic.
void subtract_self_product(const Panels& H, Eigen::MatrixXd& A);

}  // namespace gpo::joint
