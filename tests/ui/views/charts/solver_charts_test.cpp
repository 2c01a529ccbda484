// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/study_charts.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(SolverCharts, HaveACurveARunOverItsIterations) {
  SolverReport report, direct;
  report.trace = {{8, 4, 0, {}}, {2, 1, 0.5, {}}, {1, 0.1, 0.25, {}}};
  const std::array runs = {SolverRun{"gpo", 0x00FF00, &report}, SolverRun{"dbscan", 0, &direct}};
  const auto charts = solver_charts(runs);
  for (const Chart& chart : charts) {
    EXPECT_TRUE(chart.logarithmic);
    ASSERT_EQ(chart.curves.size(), 1U) << "what iterates nothing is left out";
    EXPECT_EQ(chart.curves[0].name, "gpo");
    EXPECT_EQ(chart.curves[0].rgb, 0x00FF00U);
    EXPECT_EQ(chart.curves[0].x, (std::vector<double>{0, 1, 2}));
    EXPECT_NE(chart.y_label.find('['), std::string::npos) << "a unit";
  }
  EXPECT_EQ(charts[0].curves[0].y, (std::vector<double>{8, 2, 1}));
  EXPECT_EQ(charts[1].curves[0].y, (std::vector<double>{4, 1, 0.1}));
  EXPECT_EQ(charts[2].curves[0].y, (std::vector<double>{0, 0.5, 0.25}));
}

}  // namespace
}  // namespace gpo
