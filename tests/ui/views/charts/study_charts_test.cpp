// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/study_charts.h"

#include "engine/geometry/statistics.h"
#include "engine/inspection/studies/track_life.h"
#include "tests/ui/made_inspection.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

namespace gpo {
namespace {

/// Sums the bins of a histogram; each has two points.
double sum_of_bins(const Curve& curve) {
  return std::accumulate(curve.y.begin(), curve.y.end(), 0.0) / 2;
}

TEST(ResidualCharts, HistogramsHaveAllResidualsOfWindowAndFrame) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  const WindowResiduals residuals = window_residuals(inspection);
  const int start = inspection.window->start;
  const Chart chart = residual_histogram(residuals, inspection, start + 9);
  ASSERT_EQ(chart.curves.size(), 2U);
  for (const Curve& curve : chart.curves) {
    EXPECT_NEAR(sum_of_bins(curve), 100, 1e-9) << curve.name;
    EXPECT_EQ(curve.upper, curve.y);
  }
  EXPECT_NE(chart.curves[1].name.find(std::to_string(start + 9)), std::string::npos);
  EXPECT_NE(chart.curves[1].name.find(std::to_string(residuals[9].size())), std::string::npos);
  EXPECT_EQ(residual_histogram(residuals, inspection, start).curves.size(), 1U)
      << "the reference frame";
  EXPECT_EQ(residual_histogram(residuals, inspection, start - 1).curves.size(), 1U);
}

TEST(ResidualCharts, LastBinIncludesLargerResiduals) {
  const Inspection inspection = made_inspection();
  WindowResiduals residuals(3, std::vector<double>(300, 0.5));
  residuals[1].front() = 1e12;
  residuals[1].back() = INFINITY;
  const int frame = inspection.window->start + 1;
  const Chart chart = residual_histogram(residuals, inspection, frame);
  ASSERT_EQ(chart.curves.size(), 2U);
  for (const Curve& curve : chart.curves) EXPECT_NEAR(sum_of_bins(curve), 100, 1e-9) << curve.name;
  EXPECT_NEAR(chart.curves[1].y.back(), 100 * 2 / 300.0, 1e-9);
}

TEST(ResidualCharts, HaveTheEnginesRmsAndTheTracksResiduals) {
  const Inspection inspection = made_inspection({.estimate_error = 1});
  const WindowResiduals residuals = window_residuals(inspection);
  const TrackLife track = track_life(inspection, 3);
  const Chart chart = rms_chart(residuals, inspection, &track);
  ASSERT_EQ(chart.curves.size(), 2U);
  ASSERT_EQ(static_cast<int>(chart.curves[0].y.size()), inspection.window->frame_count());
  for (int i = 0; i < inspection.window->frame_count(); ++i)
    EXPECT_DOUBLE_EQ(chart.curves[0].y[i], root_mean_square(residuals_px(inspection, i))) << i;
  EXPECT_EQ(chart.curves[0].x.front(), inspection.window->start);
  EXPECT_EQ(chart.curves[1].x.size(), track.frames.size());
  EXPECT_EQ(rms_chart(residuals, inspection, nullptr).curves.size(), 1U);
}

TEST(ResidualCharts, AreEmptyWithoutAResult) {
  const Inspection inspection = made_inspection({.ok = false});
  const WindowResiduals residuals = window_residuals(inspection);
  EXPECT_TRUE(residuals.empty());
  EXPECT_TRUE(residual_histogram(residuals, inspection, 10).curves.empty());
  EXPECT_TRUE(rms_chart(residuals, inspection, nullptr).curves.empty());
}

TEST(SolverCharts, HaveACurvePerRun) {
  SolverReport report, direct;
  report.trace = {{8, 4, 0, {}}, {2, 1, 0.5, {}}, {1, 0.1, 0.25, {}}};
  const std::array runs = {SolverRun{"gpo", 0x00FF00, &report}, SolverRun{"dbscan", 0, &direct}};
  const auto charts = solver_charts(runs);
  for (const Chart& chart : charts) {
    EXPECT_TRUE(chart.logarithmic);
    ASSERT_EQ(chart.curves.size(), 1U) << "runs without iterations are left out";
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
