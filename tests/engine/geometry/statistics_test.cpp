// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(Statistics, MedianIsUpperMedian) {
  EXPECT_EQ(median({3}), 3);
  EXPECT_EQ(median({4, 1}), 4);
  EXPECT_EQ(median({9, 1, 5}), 5);
}

TEST(Statistics, QuantilesAreInterpolated) {
  const std::vector<double> values{1, 2, 4, 8};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 1), 8);
  EXPECT_DOUBLE_EQ(quantile(values, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 1.75);
}

TEST(Statistics, RootMeanSquareOfEmptyRangeIsZero) {
  EXPECT_EQ(root_mean_square({}), 0);
  EXPECT_DOUBLE_EQ(root_mean_square(std::vector<double>{3, 4}), std::sqrt(12.5));
}

TEST(Statistics, MedianOfRayleighConvertsMedianLengthToSigma) {
  EXPECT_NEAR(kMedianOfRayleigh, std::sqrt(2 * std::log(2)), 2e-5);
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.7);
  std::vector<double> lengths;
  for (int i = 0; i < 100'000; ++i) lengths.push_back(std::hypot(noise(random), noise(random)));
  EXPECT_NEAR(median(lengths) / kMedianOfRayleigh, 0.7, 0.01);
}

}  // namespace
}  // namespace gpo
