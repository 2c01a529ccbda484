// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/tables.h"

#include "engine/experiment/figures.h"
#include "engine/experiment/summary.h"
#include "engine/files/json_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr std::array<int, 3> kOverviewFrames{10, 30, 60};

/// A column of numbers: what of results.csv, by which factor, and whether a frame's share of it.
struct NumberColumn {
  const char* title;
  std::vector<const char*> columns;  ///< whose medians are added
  double factor;
  bool per_frame;
  int digits;  ///< after the point; kSignificant: three that count
};
constexpr int kSignificant = -1;

/// With three digits that count, and none of them after an exponent: "0.0612", "3.98", "1235".
std::string significant(double value) {
  const double size = std::abs(value);
  const int before = size > 0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
  return fmt::format("{:.{}f}", value, std::clamp(2 - before, 0, 9));
}

std::set<int> lengths_in(std::span<const Row> rows) {
  std::set<int> lengths;
  for (const Row& row : rows) lengths.insert(row.settings.frames);
  return lengths;
}

std::string number(const Cell& cell, const NumberColumn& column) {
  double sum = 0;
  for (const char* name : column.columns) {
    const auto& median = cell.values.at(name).median;
    if (!median) return "-";
    sum += *median;
  }
  const double value = column.factor * sum / (column.per_frame ? cell.frames : 1);
  return column.digits == kSignificant ? significant(value)
                                       : fmt::format("{:.{}f}", value, column.digits);
}

std::string windows_of(const Cell& cell) { return fmt::format("{}/{}", cell.ok, cell.windows); }

Table time_table(const std::vector<Cell>& cells, int frames, const MethodTable& methods) {
  const std::vector<NumberColumn> columns{
      {"Front end [ms/frame]", {"track_ms", "ransac_ms"}, 1, true, 2},
      {"Rotations [ms]", {"rotations_ms"}, 1, false, 2},
      {"Initialization [ms]", {"initialize_ms"}, 1, false, 2},
      {"of it optimization [ms]", {"optimize_ms"}, 1, false, 2},
      {"Total [ms/frame]", {"total_ms"}, 1, true, 2}};
  Table table;
  table.header = {"Method", "Windows solved"};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  for (const Cell& cell : cells) {
    if (cell.frames != frames) continue;
    const Configuration configuration = parse_configuration(cell.configuration, methods);
    std::vector<std::string> line{title_of(configuration), windows_of(cell)};
    for (const NumberColumn& column : columns) line.push_back(number(cell, column));
    table.lines.push_back(std::move(line));
  }
  return table;
}

std::set<int> lengths_to_show(const std::set<int>& all) {
  if (std::ranges::includes(all, kOverviewFrames)) {
    return {kOverviewFrames.begin(), kOverviewFrames.end()};
  }
  const std::vector<int> lengths(all.begin(), all.end());
  return {lengths.front(), lengths[lengths.size() / 2], lengths.back()};
}

/// How the windows of a length were measured: "one window at a time, one thread, on an AMD EPYC".
std::string measured_text(std::span<const Row> rows, int frames) {
  std::set<int> jobs;
  std::set<std::string> processors;
  for (const Row& row : rows) {
    if (row.settings.frames != frames) continue;
    jobs.insert(row.jobs.value_or(0));
    if (!row.processor.empty()) processors.insert(row.processor);
  }
  std::string text = "one window at a time, one thread";
  if (jobs.contains(0)) {
    text = "it is not known how many windows at a time";
  } else if (*jobs.rbegin() > 1) {
    text =
        fmt::format("up to {} windows at a time, which is slower than one alone (--timing-jobs 1)",
                    *jobs.rbegin());
  }
  if (!processors.empty()) text += fmt::format(", on {}", fmt::join(processors, " and "));
  return text;
}

/// Those of an accelerometer only where there is one.
std::vector<NumberColumn> error_columns(const std::vector<Cell>& cells) {
  std::vector<NumberColumn> columns{{"PNE [deg]", {"pne_deg"}, 1, false, 3},
                                    {"ATE [mm]", {"ate_m"}, 1e3, false, kSignificant},
                                    {"PDE [mm]", {"pde_m"}, 1e3, false, kSignificant}};
  const bool inertial = std::ranges::any_of(
      cells, [](const Cell& cell) { return cell.values.at("gravity_error_deg").count > 0; });
  if (!inertial) return columns;
  columns.push_back({"scale error [%]", {"scale_error_percent"}, 1, false, kSignificant});
  columns.push_back({"gravity error [deg]", {"gravity_error_deg"}, 1, false, kSignificant});
  return columns;
}

/// `solved(cell)`: the cells for how many windows were solved.
template <class Solved>
Table errors_table(std::span<const Row> rows,
                   const std::vector<std::string>& header,
                   const Solved& solved) {
  const std::set<int> shown = lengths_to_show(lengths_in(rows));
  const std::vector<Cell> cells = summarize(rows);
  const std::vector<NumberColumn> columns = error_columns(cells);
  Table table;
  table.caption = "Medians over the solved windows";
  table.header = {"method", "frames"};
  table.header.insert(table.header.end(), header.begin(), header.end());
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  for (const Cell& cell : cells) {
    if (!shown.contains(cell.frames)) continue;
    std::vector<std::string> line{cell.configuration, std::to_string(cell.frames)};
    for (const std::string& text : solved(cell)) line.push_back(text);
    for (const NumberColumn& column : columns) line.push_back(number(cell, column));
    table.lines.push_back(std::move(line));
  }
  return table;
}

/// Of each line's cells the widest.
std::vector<std::size_t> widths_of(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& title : table.header) widths.push_back(title.size());
  for (const auto& line : table.lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  return widths;
}

using nlohmann::ordered_json;

ordered_json cells_json(std::span<const Row> rows) {
  ordered_json cells = ordered_json::array();
  for (const Cell& cell : summarize(rows)) {
    ordered_json json = {{"configuration", cell.configuration},
                         {"frames", cell.frames},
                         {"windows", cell.windows},
                         {"ok", cell.ok},
                         {"failed", cell.windows - cell.ok}};
    for (const char* name : kSummaryColumns) {
      const Distribution& d = cell.values.at(name);
      json[name] = {{"count", d.count},
                    {"lower", optional_json(d.lower)},
                    {"median", optional_json(d.median)},
                    {"upper", optional_json(d.upper)}};
    }
    cells.push_back(std::move(json));
  }
  return cells;
}

ordered_json recordings_json(const Experiment& experiment, std::span<const Row> rows) {
  ordered_json recordings = ordered_json::array();
  for (const ExperimentRecording& recording : experiment.recordings) {
    std::vector<Row> own;
    std::ranges::copy_if(rows, std::back_inserter(own), [&](const Row& row) {
      return row.recording == recording.name;
    });
    recordings.push_back({{"recording", recording.name}, {"cells", cells_json(own)}});
  }
  return recordings;
}

ordered_json figures_json(const Experiment& experiment, std::span<const Row> rows) {
  ordered_json figures = ordered_json::array();
  for (const FigurePlan& plan : figure_plans(experiment.configurations)) {
    figures.push_back(
        {{"figure", plan.name},
         {"title", plan.title},
         {"cells", cells_json(on_common_windows(rows_of(rows, plan.configurations)))}});
  }
  return figures;
}

/// How many windows were computed at once, and by which processors.
ordered_json timing_json(std::span<const Row> rows) {
  std::set<int> jobs;
  std::set<std::string> processors;
  for (const Row& row : rows) {
    if (row.jobs) jobs.insert(*row.jobs);
    if (!row.processor.empty()) processors.insert(row.processor);
  }
  return {{"jobs", jobs}, {"processors", processors}};
}

}  // namespace

Table running_time_table(std::span<const Row> rows) {
  const std::set<int> lengths = lengths_in(rows);
  const int frames = timed_length({lengths.begin(), lengths.end()});
  MethodTable methods;
  for (const Row& row : rows) methods.add(row.settings.options.method);
  Table table = time_table(summarize(rows), frames, methods);
  table.caption =
      fmt::format("Running time of different initialization methods with {} frames", frames);
  if (frames != kPaperFrames) table.caption += fmt::format(" (no windows of {})", kPaperFrames);
  table.caption += ": medians over the solved windows, " + measured_text(rows, frames);
  return table;
}

Table overview_table(std::span<const Row> rows) {
  return errors_table(
      rows, {"solved"}, [](const Cell& cell) { return std::vector{windows_of(cell)}; });
}

Table overview_numbers(std::span<const Row> rows) {
  Table table = errors_table(rows, {"solved", "of"}, [](const Cell& cell) {
    return std::vector{std::to_string(cell.ok), std::to_string(cell.windows)};
  });
  for (auto& line : table.lines) std::ranges::replace(line, "-", "");
  return table;
}

std::string to_markdown(const Table& table) {
  std::string text =
      fmt::format("{}.\n\n| {} |\n| ---", table.caption, fmt::join(table.header, " | "));
  for (std::size_t i = 1; i < table.header.size(); ++i) text += " | ---:";
  text += " |\n";
  for (const auto& line : table.lines) text += fmt::format("| {} |\n", fmt::join(line, " | "));
  return text;
}

std::string to_csv(const Table& table) {
  std::string text = fmt::format("{}\n", fmt::join(table.header, ","));
  for (const auto& line : table.lines) text += fmt::format("{}\n", fmt::join(line, ","));
  return text;
}

std::string to_text(const Table& table) {
  const std::vector<std::size_t> widths = widths_of(table);
  const auto padded = [&](const std::vector<std::string>& line) {
    std::string text = fmt::format("{:<{}}", line.front(), widths.front());
    for (std::size_t i = 1; i < line.size(); ++i) {
      text += fmt::format("  {:>{}}", line[i], widths[i]);
    }
    return text + "\n";
  };
  std::string text = padded(table.header);
  for (const auto& line : table.lines) text += padded(line);
  return text;
}

ordered_json to_json(const Experiment& experiment, std::span<const Row> rows) {
  return {{"experiment", to_json(experiment)},
          {"timing", timing_json(rows)},
          {"all_windows", cells_json(rows)},
          {"by_recording", recordings_json(experiment, rows)},
          {"windows_that_all_solved", figures_json(experiment, rows)}};
}

}  // namespace gpo
