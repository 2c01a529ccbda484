// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/experiment/summary.h"
#include "engine/methods/methods.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace gpo {
namespace {

struct Axis {
  const char* column;
  const char* title;
  const char* label;
  double factor = 1;  ///< from the column's unit to the label's
  bool logarithmic = false;
};

constexpr std::array kAxes{
    Axis{.column = "ate_m",
         .title = "Absolute trajectory error",
         .label = "ATE [mm]",
         .factor = 1e3},
    Axis{.column = "pne_deg",
         .title = "Plane normal error",
         .label = "PNE [deg]",
         .logarithmic = true},
    Axis{.column = "pde_m", .title = "Plane distance error", .label = "PDE [mm]", .factor = 1e3},
};
constexpr std::array kInertialAxes{
    Axis{.column = "scale_error_percent", .title = "Scale error", .label = "scale error [%]"},
    Axis{.column = "gravity_error_deg", .title = "Gravity error", .label = "gravity error [deg]"},
};
constexpr Axis kRmsAxis{.column = "rms_px", .title = "Reprojection error", .label = "RMS [px]"};
constexpr const char* kBoundColumn = "pne_bound_deg";
constexpr std::uint32_t kBoundColor = 0x555555;

int marker_of(const Configuration& configuration) {
  const auto built_in = methods();
  if (configuration.method.own())
    return static_cast<int>(built_in.size()) + configuration.method.row().number;
  const auto found = std::ranges::find(built_in, configuration.method.key(), &Method::key);
  return static_cast<int>(found - built_in.begin());
}

Curve curve_of(const std::vector<Cell>& cells,
               const std::string& configuration,
               const std::string& column,
               double factor) {
  Curve curve;
  const auto add = [&](std::vector<double>& to, const std::optional<double>& value) {
    to.push_back(factor * value.value_or(std::numeric_limits<double>::quiet_NaN()));
  };
  for (const Cell& cell : cells) {
    if (cell.configuration != configuration) continue;
    const Distribution& d = cell.values.at(column);
    curve.x.push_back(cell.frames);
    add(curve.y, d.median);
    add(curve.lower, d.lower);
    add(curve.upper, d.upper);
    curve.counts.push_back(d.count);
  }
  return curve;
}

/// Returns whether any value of the curve is known.
bool has_points(const Curve& curve) {
  return std::ranges::any_of(curve.y, [](double y) { return std::isfinite(y); });
}

Curve bound_curve(const std::vector<Cell>& cells, const Configuration& configuration) {
  Curve curve = curve_of(cells, key_of(configuration), kBoundColumn, 1);
  curve.name = fmt::format("bound for {}'s tracks", title_of(configuration));
  curve.rgb = kBoundColor;
  curve.dotted = true;
  curve.lower.clear();
  curve.upper.clear();
  curve.counts.clear();
  return curve;
}

Chart chart_of(const std::vector<Cell>& cells, const FigurePlan& plan, const Axis& axis) {
  Chart chart{.title = axis.title,
              .x_label = "window [frames]",
              .y_label = axis.label,
              .logarithmic = axis.logarithmic};
  for (const Configuration& configuration : plan.configurations) {
    Curve curve = curve_of(cells, key_of(configuration), axis.column, axis.factor);
    if (curve.x.empty()) continue;
    curve.name = title_of(configuration);
    curve.rgb = color_of(configuration);
    curve.marker = marker_of(configuration);
    chart.curves.push_back(std::move(curve));
  }
  if (axis.column != std::string("pne_deg")) return chart;
  Curve bound = bound_curve(cells, plan.configurations.front());
  if (has_points(bound)) chart.curves.push_back(std::move(bound));
  return chart;
}

std::string windows_text(const std::vector<Cell>& cells, const FigurePlan& plan) {
  std::string text = "none";
  if (!cells.empty()) {
    const auto [least, most] = std::ranges::minmax(cells, {}, &Cell::windows);
    text = least.windows == most.windows ? std::to_string(most.windows)
                                         : fmt::format("{} to {}", least.windows, most.windows);
  }
  text += " per length";
  for (const Configuration& configuration : plan.configurations) {
    const std::string key = key_of(configuration);
    const bool has = std::ranges::find(cells, key, &Cell::configuration) != cells.end();
    if (!has) text += ", none solved by " + title_of(configuration);
  }
  return text;
}

std::vector<Cell> common_cells(std::span<const Row> rows, const FigurePlan& plan) {
  return summarize(on_common_windows(rows_of(rows, plan.configurations)));
}

/// Returns whether any window has an error, so that the residuals need not stand in for them.
bool has_errors(std::span<const Row> rows) {
  return std::ranges::any_of(rows,
                             [](const Row& row) { return row.ate_m || row.pne_deg || row.pde_m; });
}

Figure metric_figure(std::span<const Row> rows, const FigurePlan& plan) {
  const std::vector<Cell> cells = common_cells(rows, plan);
  Figure figure{
      plan.name + "_meters", plan.title + ": gravity and metric scale by the accelerometer", {}};
  for (const Axis& axis : kInertialAxes)
    if (has_values(cells, axis.column)) figure.charts.push_back(chart_of(cells, plan, axis));
  return figure;
}

}  // namespace

Figure figure_over_length(std::span<const Row> rows, const FigurePlan& plan) {
  const std::vector<Cell> cells = common_cells(rows, plan);
  Figure figure{
      .name = plan.name,
      .title = fmt::format("{}: median and quartiles over the windows that all of them solved ({})",
                           plan.title,
                           windows_text(cells, plan)),
      .note = !has_points(bound_curve(cells, plan.configurations.front()))
                  ? ""
                  : fmt::format("Dotted: Cram\u00e9r-Rao bound of the error for the inliers of {}, "
                                "their noise and known "
                                "rotations. Other tracks, inliers or noise have another bound, so "
                                "a curve may be below "
                                "this one.",
                                title_of(plan.configurations.front()))};
  for (const Axis& axis : kAxes) figure.charts.push_back(chart_of(cells, plan, axis));
  return figure;
}

Figure figure_without_truth(std::span<const Row> rows, const FigurePlan& plan) {
  return {plan.name, plan.title, {chart_of(common_cells(rows, plan), plan, kRmsAxis)}};
}

std::vector<Figure> figures(std::span<const Row> rows,
                            const std::vector<Configuration>& configurations) {
  std::vector<Figure> all;
  for (const FigurePlan& plan : figure_plans(configurations)) {
    all.push_back(has_errors(rows) ? figure_over_length(rows, plan)
                                   : figure_without_truth(rows, plan));
    Figure metric = metric_figure(rows, plan);
    if (!metric.charts.empty()) all.push_back(std::move(metric));
  }
  for (Figure& figure : all)
    for (Chart& chart : figure.charts)
      std::erase_if(chart.curves, [](const Curve& curve) { return !has_points(curve); });
  return all;
}

}  // namespace gpo
