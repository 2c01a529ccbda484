// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace gpo::joint {

/// Subtracts H H^T from the lower triangle of A, with the widest instructions of the processor:
/// more than half of the joint model's arithmetic.
void subtract_self_product(const Eigen::MatrixXd& H, Eigen::MatrixXd& A);

}  // namespace gpo::joint
