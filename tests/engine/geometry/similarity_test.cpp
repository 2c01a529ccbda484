// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/similarity.h"

#include "engine/geometry/pose.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(Similarity, RecoversAKnownOne) {
  std::srand(3);
  const Similarity truth{2.5, so3_exp({0.3, -0.7, 1.1}), {1, 2, 3}};
  const Eigen::Matrix3Xd from = Eigen::Matrix3Xd::Random(3, 20);
  Eigen::Matrix3Xd to(3, 20);
  for (int k = 0; k < 20; ++k) to.col(k) = truth * from.col(k);
  const Similarity found = align(from, to);
  EXPECT_NEAR(found.scale, 2.5, 1e-12);
  EXPECT_LT((found.R_ab - truth.R_ab).norm(), 1e-12);
  EXPECT_LT((found.t_ab - truth.t_ab).norm(), 1e-12);
}

TEST(Similarity, KnowsWhatAPathDetermines) {
  std::srand(4);
  const Eigen::Matrix3Xd wobble = Eigen::Matrix3Xd::Random(3, 30);
  const Eigen::RowVectorXd along = Eigen::RowVectorXd::LinSpaced(30, 0, 0.3);
  Eigen::Matrix3Xd line = 1e-3 * wobble;
  line.row(0) += along;
  EXPECT_EQ(determined_alignment(wobble, 1), Alignment::ok);
  EXPECT_EQ(determined_alignment(line, 1), Alignment::line);
  EXPECT_EQ(determined_alignment(1e-4 * wobble, 1), Alignment::point);
}

}  // namespace
}  // namespace gpo
