// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/charts/study_charts.h"

#include "engine/geometry/statistics.h"
#include "engine/inspection/studies/track_life.h"
#include "engine/methods/common/window_checks.h"
#include "ui/context/theme.h"
#include "ui/views/charts/axis_ticks.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kBins = 24;

Curve named_curve(std::string name, std::uint32_t rgb) {
  Curve curve;
  curve.name = std::move(name);
  curve.rgb = rgb;
  return curve;
}

Chart empty_chart(std::string title, std::string x_label, std::string y_label) {
  Chart chart;
  chart.title = std::move(title);
  chart.x_label = std::move(x_label);
  chart.y_label = std::move(y_label);
  return chart;
}

std::uint32_t method_rgb(const Inspection& inspection) {
  return inspection.settings.options.method.row().rgb;
}

std::vector<double> all_of(const WindowResiduals& residuals) {
  std::vector<double> all;
  for (std::size_t i = 1; i < residuals.size(); ++i)
    all.insert(all.end(), residuals[i].begin(), residuals[i].end());
  std::ranges::sort(all);
  return all;
}

/// Returns a round bin width for 99 % of the residuals [px].
double bin_width(const std::vector<double>& sorted) {
  const double most = sorted[(sorted.size() - 1) * 99 / 100];
  const AxisTicks ticks = linear_ticks(0, std::max(most, 1e-6), kBins);
  return ticks.values[1] - ticks.values[0];
}

/// The last bin also counts larger values and NaN.
int bin_of(double value, double width) {
  const double bin = std::floor(value / width);
  return bin < kBins ? static_cast<int>(bin) : kBins - 1;
}

/// Returns a histogram in percent, filled down to zero.
Curve steps(std::string name, std::uint32_t rgb, std::span<const double> values, double width) {
  std::vector<double> share(kBins, 0);
  for (const double value : values)
    share[bin_of(value, width)] += 100.0 / static_cast<double>(values.size());
  Curve curve = named_curve(std::move(name), rgb);
  for (int k = 0; k < kBins; ++k) {
    curve.x.insert(curve.x.end(), {k * width, (k + 1) * width});
    curve.y.insert(curve.y.end(), {share[k], share[k]});
  }
  curve.lower.assign(curve.y.size(), 0);
  curve.upper = curve.y;
  return curve;
}

Curve curve_of(const SolverRun& run, double SolverStep::*value) {
  Curve curve = named_curve(run.name, run.rgb);
  for (const SolverStep& step : run.report->trace) {
    curve.x.push_back(static_cast<double>(curve.x.size()));
    curve.y.push_back(step.*value);
  }
  return curve;
}

}  // namespace

WindowResiduals window_residuals(const Inspection& inspection) {
  WindowResiduals residuals;
  for (int i = 0; inspection.initialization->ok && i < inspection.window->frame_count(); ++i)
    residuals.push_back(residuals_px(inspection, i));
  return residuals;
}

Chart residual_histogram(const WindowResiduals& residuals,
                         const Inspection& inspection,
                         int frame) {
  Chart chart = empty_chart("Residuals", "residual [px]", "share [%]");
  const std::vector<double> all = all_of(residuals);
  if (all.empty()) return chart;
  const double width = bin_width(all);
  const std::string name = fmt::format("window, {} inliers", all.size());
  chart.curves.push_back(steps(name, method_rgb(inspection), all, width));
  const int i = frame - inspection.window->start;
  if (i < 1 || i >= static_cast<int>(residuals.size()) || residuals[i].empty()) return chart;
  const std::string own = fmt::format("frame {}, {} inliers", frame, residuals[i].size());
  chart.curves.push_back(steps(own, color_of(Role::residual), residuals[i], width));
  return chart;
}

Chart rms_chart(const WindowResiduals& residuals,
                const Inspection& inspection,
                const TrackLife* track) {
  Chart chart = empty_chart("Frame by frame", "frame", "residual [px]");
  Curve rms = named_curve("RMS of the inliers", method_rgb(inspection));
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    rms.x.push_back(inspection.window->start + static_cast<double>(i));
    rms.y.push_back(residuals[i].empty() ? NAN : root_mean_square(residuals[i]));
  }
  if (residuals.empty()) return chart;
  chart.curves.push_back(std::move(rms));
  if (track == nullptr) return chart;
  Curve own = named_curve(fmt::format("track {}", track->id), color_of(Role::selected));
  for (const TrackFrame& frame : track->frames) {
    own.x.push_back(frame.frame);
    own.y.push_back(frame.residual_px.value_or(NAN));
  }
  chart.curves.push_back(std::move(own));
  return chart;
}

std::array<Chart, 3> solver_charts(std::span<const SolverRun> runs) {
  std::array<Chart, 3> charts = {
      empty_chart("Cost", "iteration", "half the sum of squares [px\u00b2]"),
      empty_chart("Gradient", "iteration", "largest component [px\u00b2]"),
      empty_chart("Step", "iteration", "norm over all unknowns [-]")};
  for (Chart& chart : charts) chart.logarithmic = true;
  for (const SolverRun& run : runs) {
    if (run.report->trace.empty()) continue;
    charts[0].curves.push_back(curve_of(run, &SolverStep::cost));
    charts[1].curves.push_back(curve_of(run, &SolverStep::gradient));
    charts[2].curves.push_back(curve_of(run, &SolverStep::step));
  }
  return charts;
}

}  // namespace gpo
