// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/axis_ticks.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using ::testing::ElementsAre;
using ::testing::SizeIs;

TEST(AxisTicks, LinearAreRoundNumbersWithinTheRange) {
  const AxisTicks ticks = linear_ticks(4.25, 30.75, 7);
  EXPECT_EQ(ticks.low, 4.25);
  EXPECT_EQ(ticks.high, 30.75);
  EXPECT_THAT(ticks.labels, ElementsAre("5", "10", "15", "20", "25", "30"));
  EXPECT_THAT(linear_ticks(0, 0.3, 4).labels, ElementsAre("0", "0.1", "0.2", "0.3"));
  for (double high = 0.01; high < 1e4; high *= 1.7)
    EXPECT_LE(linear_ticks(0, high, 5).values.size(), 6U) << high;
}

TEST(AxisTicks, LogarithmicExtendToRoundNumbers) {
  const AxisTicks ticks = logarithmic_ticks(0.03, 0.8, 8);
  EXPECT_THAT(ticks.labels, ElementsAre("0.02", "0.05", "0.1", "0.2", "0.5", "1"));
  EXPECT_EQ(ticks.low, 0.02);
  EXPECT_EQ(ticks.high, 1);
  EXPECT_THAT(logarithmic_ticks(0.001, 100, 7).labels,
              ElementsAre("0.001", "0.01", "0.1", "1", "10", "100"));
  EXPECT_THAT(logarithmic_ticks(1e-6, 1e6, 8).values, SizeIs(7));
}

TEST(AxisTicks, ExtendARangeOfOneValue) {
  const AxisTicks linear = linear_ticks(30, 30, 5), logarithmic = logarithmic_ticks(1, 1, 5);
  EXPECT_LT(linear.low, 30);
  EXPECT_GT(linear.high, 30);
  EXPECT_EQ(logarithmic.low, 1);
  EXPECT_EQ(logarithmic.high, 2);
}

TEST(AxisTicks, AreAtLeastThree) {
  for (const double low : {0.0, 0.013, 1.0, 9.6, 3700.0})
    for (const double length : {0.003, 0.4, 1.01, 2.9, 30.0, 720.0})
      for (const int most : {1, 2, 3, 8})
        EXPECT_GE(linear_ticks(low, low + length, most).values.size(), 3U) << low << " " << length;
  for (const double low : {0.0012, 0.1, 0.5, 1.0, 7.0})
    for (const double factor : {1.0, 1.05, 1.9, 2.5, 6.0, 40.0, 900.0, 1e7})
      for (const int most : {2, 3, 4, 8}) {
        const AxisTicks ticks = logarithmic_ticks(low, factor * low, most);
        EXPECT_GE(ticks.values.size(), 3U) << low << " x " << factor << ", " << most;
        EXPECT_GE(ticks.values.front(), ticks.low);
        EXPECT_LE(ticks.values.back(), ticks.high);
      }
  EXPECT_THAT(logarithmic_ticks(0.12, 0.18, 4).labels, ElementsAre("0.1", "0.15", "0.2"));
}

}  // namespace
}  // namespace gpo
