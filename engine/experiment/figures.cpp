// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/figures.h"

#include "engine/experiment/summary.h"
#include "engine/methods/methods.h"

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

bool is_plain(const Configuration& c) { return c == Configuration{.method = c.method}; }

bool is_gpo(const Configuration& c) { return is_plain(c) && c.method == "gpo"; }

bool is_of(const Configuration& c, MethodFamily family) {
  return is_gpo(c) || (is_plain(c) && c.method.row().family == family);
}

/// The method as it is, or with nothing but that setting changed.
bool varies(const Configuration& c, const char* method, const char* setting) {
  const bool only = c.changes.size() == 1 && c.names(setting);
  return c.method == method && (c.changes.empty() || only);
}

/// A figure of the paper, and which configurations are in it. Of two of them its title is true, if
/// one is what it names.
struct PaperFigure {
  const char* name;
  const char* title;
  bool (*shows)(const Configuration& configuration);
  bool names_gpo;  ///< beside others
};

constexpr std::array kPaperFigures{
    PaperFigure{"aggregation",
                "GPO and aggregation-based methods",
                [](const Configuration& c) { return is_of(c, MethodFamily::aggregation); },
                true},
    PaperFigure{"optimization",
                "GPO and optimization-based methods",
                [](const Configuration& c) { return is_of(c, MethodFamily::optimization); },
                true},
    PaperFigure{"gpo_ransac",
                "GPO with and without RANSAC",
                [](const Configuration& c) { return varies(c, "gpo", "ransac"); },
                false},
    PaperFigure{"rotation_sources",
                "GPO by the source of its rotations",
                [](const Configuration& c) { return varies(c, "gpo", "rotations"); },
                false},
    PaperFigure{"ba_ransac",
                "BA with and without RANSAC",
                [](const Configuration& c) { return varies(c, "ba", "ransac"); },
                false},
};

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

std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations) {
  std::vector<FigurePlan> plans;
  std::vector<Configuration> shown;
  for (const PaperFigure& figure : kPaperFigures) {
    FigurePlan plan{figure.name, figure.title, {}};
    std::ranges::copy_if(configurations, std::back_inserter(plan.configurations), figure.shows);
    if (plan.configurations.size() < 2) continue;
    if (figure.names_gpo && std::ranges::none_of(plan.configurations, is_gpo)) continue;
    shown.insert(shown.end(), plan.configurations.begin(), plan.configurations.end());
    plans.push_back(std::move(plan));
  }
  const bool all_shown = std::ranges::all_of(configurations, [&](const Configuration& c) {
    return std::ranges::find(shown, c) != shown.end();
  });
  if (!all_shown) plans.push_back({"configurations", "All configurations", configurations});
  return plans;
}

}  // namespace gpo
