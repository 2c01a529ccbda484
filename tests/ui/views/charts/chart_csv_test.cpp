// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/chart_view.h"

#include <limits>

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(ChartCsv, HasALineAPointWithUnits) {
  Chart chart{"", "frames", "error, all [px]", false, {}};
  chart.curves.push_back({.name = "gpo", .x = {1, 2.5}, .y = {0.25, 3}, .lower = {}, .upper = {}});
  EXPECT_EQ(to_csv(chart), "curve,frames,error; all [px]\ngpo,1,0.25\ngpo,2.5,3\n");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  chart.curves.push_back({.name = "ba", .x = {1}, .y = {nan}, .lower = {0.5}, .upper = {2}});
  EXPECT_EQ(to_csv(chart),
            "curve,frames,error; all [px],lower,upper\ngpo,1,0.25,,\ngpo,2.5,3,,\nba,1,,0.5,2\n");
}

}  // namespace
}  // namespace gpo
