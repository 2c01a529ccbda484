// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/uncertainty/information.h"

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

TEST(ShrunkCovariance, IsZeroWithoutErrors) {
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(6, 6);
  EXPECT_EQ(shrunk_covariance(zero.leftCols(4), zero, zero), zero);
}

}  // namespace
}  // namespace gpo::test
