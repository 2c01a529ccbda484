// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/decompositions.h"

#include "engine/geometry/pose.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gpo {
namespace {

Eigen::MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(random); });
}

TEST(Decompositions, EigenvectorsAreOrthonormalAndRestoreMatrix) {
  const Eigen::MatrixXd B = random_matrix(9, 7, 1);
  const Eigen::MatrixXd A = B * B.transpose();
  const auto [values, vectors] = symmetric_eigen(A);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  EXPECT_LT(std::abs(values(0)) + std::abs(values(1)), 1e-12 * values(8));  // rank 7
  EXPECT_TRUE((vectors.transpose() * vectors).isIdentity(1e-12));
  EXPECT_TRUE((vectors * values.asDiagonal() * vectors.transpose()).isApprox(A, 1e-12));
}

TEST(Decompositions, SolveLinearSystems) {
  const Eigen::MatrixXd B = random_matrix(20, 6, 2);
  const Eigen::MatrixXd A = B.transpose() * B, X = random_matrix(6, 3, 3);
  EXPECT_TRUE(solve_symmetric(A, A * X).isApprox(X, 1e-10));
  EXPECT_TRUE((inverse_of_symmetric(A) * A).isIdentity(1e-10));
  const Eigen::VectorXd b = random_matrix(20, 1, 5);
  EXPECT_LT((B.transpose() * (B * least_squares(B, b) - b)).norm(), 1e-12);
}

TEST(NearestRotation, HasLeastDistanceAndKeepsRotationWrittenWithFewDigits) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Eigen::Matrix3d M = random_matrix(3, 3, seed);  // half of them are reflections
    const Eigen::Matrix3d R = nearest_rotation(M);
    ASSERT_TRUE((R * R.transpose()).isIdentity(1e-12));
    ASSERT_GT(R.determinant(), 0);
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d w = 0.3 * random_matrix(3, 1, 100 * seed + k);
      EXPECT_GE((R * so3_exp(w) - M).norm(), (R - M).norm() - 1e-12);
    }
  }
  const Eigen::Matrix3d R = so3_exp({0.3, -0.2, 0.9});
  EXPECT_EQ(rotation_meant(R, 1e-3), R);
  Eigen::Matrix3d digits = (1e4 * R).array().round() / 1e4;
  const auto meant = rotation_meant(digits, 1e-3);
  ASSERT_TRUE(meant);
  EXPECT_TRUE((*meant * meant->transpose()).isIdentity(1e-12));
  EXPECT_LT((*meant - R).norm(), 2e-4);
  EXPECT_FALSE(rotation_meant(1.01 * R, 1e-3));
  EXPECT_FALSE(rotation_meant(-R, 1e-3));
}

TEST(Similarity, RecoversKnownSimilarityAndClassifiesPaths) {
  std::srand(3);
  const Similarity truth{2.5, so3_exp({0.3, -0.7, 1.1}), {1, 2, 3}};
  const Eigen::Matrix3Xd from = Eigen::Matrix3Xd::Random(3, 20);
  Eigen::Matrix3Xd to(3, 20);
  for (int k = 0; k < 20; ++k) to.col(k) = truth * from.col(k);
  const Similarity found = align(from, to);
  EXPECT_NEAR(found.scale, 2.5, 1e-12);
  EXPECT_LT((found.R_ab - truth.R_ab).norm(), 1e-12);
  EXPECT_LT((found.t_ab - truth.t_ab).norm(), 1e-12);
  std::srand(4);
  const Eigen::Matrix3Xd wobble = Eigen::Matrix3Xd::Random(3, 30);
  const Eigen::RowVectorXd along = Eigen::RowVectorXd::LinSpaced(30, 0, 0.3);
  Eigen::Matrix3Xd line = 1e-3 * wobble;
  line.row(0) += along;
  EXPECT_EQ(determined_alignment(wobble, 1), Alignment::ok);
  EXPECT_EQ(determined_alignment(line, 1), Alignment::line);
  EXPECT_EQ(determined_alignment(1e-4 * wobble, 1), Alignment::point);
}

TEST(Statistics, ReturnsUpperMedianQuantilesRootMeanSquareAndSigmaOfLengths) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({4, 1}), 4);
  EXPECT_EQ(median({9, 1, 5}), 5);
  const std::vector<double> values{1, 2, 4, 8};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 1), 8);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
  EXPECT_EQ(parabola_minimum(4, 1, 0), 1);
  for (const double after : {1.0, 0.0, std::nan("")}) EXPECT_FALSE(parabola_minimum(1, 1, after));
  EXPECT_EQ(root_mean_square({}), 0);
  EXPECT_DOUBLE_EQ(root_mean_square(std::vector<double>{3, 4}), std::sqrt(12.5));
  EXPECT_NEAR(kMedianOfRayleigh, std::sqrt(2 * std::log(2)), 2e-5);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.7);
  std::vector<double> lengths;
  for (int i = 0; i < 100'000; ++i) lengths.push_back(std::hypot(noise(random), noise(random)));
  EXPECT_NEAR(median(lengths) / kMedianOfRayleigh, 0.7, 0.01);
}

}  // namespace
}  // namespace gpo
