// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/figures.h"

#include "engine/experiment/summary.h"
#include "engine/initializers/methods.h"

#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

namespace gpo {
namespace {

/// A column of results.csv as an axis.
struct Axis {
  const char* column;
  const char* title;
  const char* label;
  double factor;  ///< from the column's unit to the label's
  bool logarithmic;
};

constexpr std::array kAxes{
    Axis{"ate_m", "Absolute trajectory error", "ATE [mm]", 1e3, false},
    Axis{"pne_deg", "Plane normal error", "PNE [deg]", 1, true},
    Axis{"pde_m", "Plane distance error", "PDE [mm]", 1e3, false},
};
/// Where an accelerometer told them.
constexpr std::array kInertialAxes{
    Axis{"scale_error_percent", "Scale error", "scale error [%]", 1, false},
    Axis{"gravity_error_deg", "Gravity error", "gravity error [deg]", 1, false},
};
constexpr Axis kRmsAxis{"rms_px", "Reprojection error", "RMS [px]", 1, false};
constexpr const char* kBoundColumn = "pne_bound_deg";
constexpr std::uint32_t kBoundColor = 0x555555;

/// A method has its own in all figures, with whatever settings.
int marker_of(const Configuration& configuration) {
  const auto ours = methods();
  if (configuration.method.own())
    return static_cast<int>(ours.size()) + configuration.method.row().number;
  const auto found = std::ranges::find(ours, configuration.method.key(), &Method::key);
  return static_cast<int>(found - ours.begin());
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
  Chart chart{axis.title, "window [frames]", axis.label, axis.logarithmic, {}};
  for (const Configuration& configuration : plan.configurations) {
    Curve curve = curve_of(cells, key_of(configuration), axis.column, axis.factor);
    if (curve.x.empty()) continue;
    curve.name = title_of(configuration);
    curve.rgb = color_of(configuration);
    curve.marker = marker_of(configuration);
    chart.curves.push_back(std::move(curve));
  }
  if (axis.column == std::string("pne_deg")) {
    chart.curves.push_back(bound_curve(cells, plan.configurations.front()));
  }
  return chart;
}

/// How many windows each point of the curves stands for, and who has no curve.
std::string windows_text(const std::vector<Cell>& cells, const FigurePlan& plan) {
  std::string text = "none";
  if (!cells.empty()) {
    const auto [least, most] = std::ranges::minmax(cells, {}, &Cell::windows);
    text = least.windows == most.windows ? std::to_string(most.windows)
                                         : fmt::format("{} to {}", least.windows, most.windows);
  }
  text += " a length";
  for (const Configuration& configuration : plan.configurations) {
    const std::string key = key_of(configuration);
    const bool has = std::ranges::find(cells, key, &Cell::configuration) != cells.end();
    if (!has) text += ", none solved by " + title_of(configuration);
  }
  return text;
}

/// What the dotted curve is.
std::string note_of(const FigurePlan& plan) {
  return fmt::format(
      "Dotted: the least error (Cram\u00e9r-Rao) that the inliers of {}, their noise and known "
      "rotations allow; with other tracks, inliers or noise the bound is another, and a curve may "
      "be below this one.",
      title_of(plan.configurations.front()));
}

}  // namespace

Figure figure_over_length(std::span<const Row> rows, const FigurePlan& plan) {
  const std::vector<Cell> cells = summarize(on_common_windows(rows_of(rows, plan.configurations)));
  Figure figure{
      plan.name,
      fmt::format("{}: median and quartiles over the windows that all of them solved ({})",
                  plan.title,
                  windows_text(cells, plan)),
      {}};
  for (const Axis& axis : kAxes) figure.charts.push_back(chart_of(cells, plan, axis));
  figure.note = note_of(plan);
  return figure;
}

Figure figure_of_meters(std::span<const Row> rows, const FigurePlan& plan) {
  const std::vector<Cell> cells = summarize(on_common_windows(rows_of(rows, plan.configurations)));
  Figure figure{
      plan.name + "_meters", plan.title + ": gravity and meters by the accelerometer", {}};
  for (const Axis& axis : kInertialAxes) {
    const bool known = std::ranges::any_of(
        cells, [&](const Cell& cell) { return cell.values.at(axis.column).count > 0; });
    if (known) figure.charts.push_back(chart_of(cells, plan, axis));
  }
  return figure;
}

Figure figure_without_truth(std::span<const Row> rows, const FigurePlan& plan) {
  const std::vector<Cell> cells = summarize(on_common_windows(rows_of(rows, plan.configurations)));
  return {plan.name, plan.title, {chart_of(cells, plan, kRmsAxis)}};
}

std::vector<Figure> figures(std::span<const Row> rows,
                            const std::vector<Configuration>& configurations) {
  std::vector<Figure> all;
  for (const FigurePlan& plan : figure_plans(configurations)) {
    all.push_back(figure_over_length(rows, plan));
    Figure meters = figure_of_meters(rows, plan);
    if (!meters.charts.empty()) all.push_back(std::move(meters));
  }
  return all;
}

}  // namespace gpo
