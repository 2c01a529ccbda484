// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary.h"

#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;

const std::vector<std::string> kSummaryColumns = split(
    "rms_px,ate_m,pne_deg,pne_aligned_deg,pde_m,pne_bound_deg,scale_ratio,path_error_m,"
    "path_error_percent,scale_error_percent,gravity_error_deg,track_ms,ransac_ms,rotations_ms,"
    "initialize_ms,optimize_ms,total_ms",
    ',');

using WindowKey = std::tuple<std::string, int, int>;  // recording, start, frames
WindowKey window_of(const Row& row) {
  return {row.recording, row.settings.start, row.settings.frames};
}

Cell cell_of(std::span<const Row> rows, const std::string& configuration, int frames) {
  Cell cell{.configuration = configuration, .frames = frames};
  std::map<std::string, std::vector<double>> values;
  for (const Row& row : rows) {
    if (row.configuration != configuration || row.settings.frames != frames) continue;
    ++cell.windows;
    if (!row.ok()) continue;
    ++cell.ok;
    visit_row(row, [&](const std::string& name, const auto& value) {
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::optional<double>>)
        if (value) values[name].push_back(std::abs(*value));
    });
  }
  for (const std::string& name : kSummaryColumns) cell.values[name] = distribution(values[name]);
  return cell;
}

std::string number(const Cell& cell, const NumberColumn& column) {
  double sum = 0;
  for (const char* name : column.columns) {
    const auto median = distribution_of(cell, name).median;
    if (!median) return "-";
    sum += *median;
  }
  return formatted(sum / (column.per_frame ? cell.frames : 1), column);
}

std::string windows_of(const Cell& cell) { return fmt::format("{}/{}", cell.ok, cell.windows); }

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
    text = "unknown number of windows at a time";
  } else if (*jobs.rbegin() > 1) {
    text = fmt::format(
        "up to {} windows at a time, which is slower than one at a time (--timing-jobs 1)",
        *jobs.rbegin());
  }
  if (!processors.empty()) text += fmt::format(", on {}", fmt::join(processors, " and "));
  return text;
}

/// Cells of the lengths to show, from all windows and from those that all methods solved.
struct Overview {
  std::vector<Cell> cells = {};
  std::vector<Cell> common_cells = {};  ///< one per cell; without windows if it solved none
  std::vector<NumberColumn> columns;
};

Overview overview_of(std::span<const Row> rows) {
  const std::vector<Cell> all = summarize(rows), common = summarize(on_common_windows(rows));
  const std::set<int> shown = lengths_to_show(lengths_in(rows));
  Overview overview{.columns = error_columns(all)};
  for (const Cell& cell : all) {
    if (!shown.contains(cell.frames)) continue;
    overview.cells.push_back(cell);
    overview.common_cells.push_back(cell_or_empty(common, cell.configuration, cell.frames));
  }
  return overview;
}

ordered_json cells_json(std::span<const Row> rows) {
  ordered_json cells = ordered_json::array();
  for (const Cell& cell : summarize(rows)) {
    ordered_json json = {{"configuration", cell.configuration},
                         {"frames", cell.frames},
                         {"windows", cell.windows},
                         {"ok", cell.ok},
                         {"failed", cell.windows - cell.ok}};
    for (const std::string& name : kSummaryColumns) {
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
    const auto own = [&](const Row& row) { return row.recording == recording.name; };
    recordings.push_back(
        {{"recording", recording.name}, {"cells", cells_json(rows_where(rows, own))}});
  }
  return recordings;
}

ordered_json figures_json(const Experiment& experiment, std::span<const Row> rows) {
  ordered_json figures = ordered_json::array();
  for (const FigurePlan& plan : figure_plans(experiment.configurations))
    figures.push_back(
        {{"figure", plan.name},
         {"title", plan.title},
         {"cells", cells_json(on_common_windows(rows_of(rows, plan.configurations)))}});
  return figures;
}

ordered_json timing_json(std::span<const Row> rows) {
  std::set<int> jobs;
  std::set<std::string> processors;
  for (const Row& row : rows) {
    if (row.jobs) jobs.insert(*row.jobs);
    if (!row.processor.empty()) processors.insert(row.processor);
  }
  return {{"jobs", jobs}, {"processors", processors}};
}

/// Formats three significant digits without an exponent.
std::string significant(double value) {
  const double size = std::abs(value);
  const int before = size > 0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
  return fmt::format("{:.{}f}", value, std::clamp(2 - before, 0, 9));
}

}  // namespace

std::vector<std::string> unique_of(std::span<const Row> rows, std::string Row::*member) {
  std::vector<std::string> found;
  for (const Row& row : rows)
    if (std::ranges::find(found, row.*member) == found.end()) found.push_back(row.*member);
  return found;
}

std::set<int> lengths_in(std::span<const Row> rows) {
  std::set<int> lengths;
  for (const Row& row : rows) lengths.insert(row.settings.frames);
  return lengths;
}

std::set<int> lengths_to_show(const std::set<int>& all) {
  constexpr std::array kPreferred{10, 30, 60};
  if (std::ranges::includes(all, kPreferred)) return {kPreferred.begin(), kPreferred.end()};
  const std::vector<int> lengths(all.begin(), all.end());
  return {lengths.front(), lengths[lengths.size() / 2], lengths.back()};
}

Distribution distribution(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  return {static_cast<int>(values.size()),
          quantile(values, 0.25),
          quantile(values, 0.5),
          quantile(values, 0.75)};
}

std::vector<Cell> summarize(std::span<const Row> rows) {
  std::vector<Cell> cells;
  for (const std::string& configuration : unique_of(rows, &Row::configuration))
    for (const int frames : lengths_in(rows)) cells.push_back(cell_of(rows, configuration, frames));
  std::erase_if(cells, [](const Cell& cell) { return cell.windows == 0; });
  return cells;
}

Cell cell_or_empty(std::span<const Cell> cells, const std::string& configuration, int frames) {
  const auto found = std::ranges::find_if(cells, [&](const Cell& one) {
    return one.configuration == configuration && one.frames == frames;
  });
  return found == cells.end() ? Cell{.configuration = configuration, .frames = frames} : *found;
}

Distribution distribution_of(const Cell& cell, const std::string& column) {
  const auto found = cell.values.find(column);
  return found == cell.values.end() ? Distribution{} : found->second;
}

bool has_values(std::span<const Cell> cells, const std::string& column) {
  return std::ranges::any_of(
      cells, [&](const Cell& cell) { return distribution_of(cell, column).count > 0; });
}

std::string formatted(double value, const NumberColumn& column) {
  return column.digits == kSignificant
             ? significant(column.factor * value)
             : fmt::format("{:.{}f}", column.factor * value, column.digits);
}

std::vector<NumberColumn> error_columns(std::span<const Cell> cells) {
  std::vector<NumberColumn> columns{{.title = "PNE [deg]", .columns = {"pne_deg"}, .digits = 3},
                                    {.title = "ATE [mm]", .columns = {"ate_m"}, .factor = 1e3},
                                    {.title = "PDE [mm]", .columns = {"pde_m"}, .factor = 1e3}};
  const bool gravity = has_values(cells, "gravity_error_deg");
  if (gravity || has_values(cells, "scale_error_percent"))
    columns.push_back({.title = "scale error [%]", .columns = {"scale_error_percent"}});
  if (gravity)
    columns.push_back({.title = "gravity error [deg]", .columns = {"gravity_error_deg"}});
  return columns;
}

std::vector<Row> on_common_windows(std::span<const Row> rows) {
  std::map<int, std::set<std::string>> solvers;  // configurations
  std::map<WindowKey, std::set<std::string>> solved;
  for (const Row& row : rows) {
    if (!row.ok()) continue;
    solvers[row.settings.frames].insert(row.configuration);
    solved[window_of(row)].insert(row.configuration);
  }
  return rows_where(rows, [&](const Row& row) {
    return row.ok() && solved[window_of(row)] == solvers[row.settings.frames];
  });
}

std::vector<Row> rows_of(std::span<const Row> rows, std::span<const Configuration> configurations) {
  std::set<std::string> keys;
  for (const Configuration& configuration : configurations) keys.insert(key_of(configuration));
  return rows_where(rows, [&](const Row& row) { return keys.contains(row.configuration); });
}

Table running_time_table(std::span<const Row> rows) {
  const std::vector<NumberColumn> columns{
      {.title = "Front end [ms/frame]",
       .columns = {"track_ms", "ransac_ms"},
       .per_frame = true,
       .digits = 2},
      {.title = "Rotations [ms]", .columns = {"rotations_ms"}, .digits = 2},
      {.title = "Initialization [ms]", .columns = {"initialize_ms"}, .digits = 2},
      {.title = "of which optimization [ms]", .columns = {"optimize_ms"}, .digits = 2},
      {.title = "Total [ms/frame]", .columns = {"total_ms"}, .per_frame = true, .digits = 2}};
  const std::set<int> lengths = lengths_in(rows);
  const int frames = timed_length({lengths.begin(), lengths.end()});
  MethodTable methods;
  for (const Row& row : rows) methods.add(row.settings.options.method);
  Table table;
  table.caption =
      fmt::format("Running time of different initialization methods with {} frames", frames);
  if (frames != kPaperFrames) table.caption += fmt::format(" (no windows of {})", kPaperFrames);
  table.caption += ": medians over the solved windows, " + measured_text(rows, frames);
  table.header = {"Method", "Windows solved"};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  for (const Cell& cell : summarize(rows)) {
    if (cell.frames != frames) continue;
    const Configuration configuration = parse_configuration(cell.configuration, methods);
    std::vector<std::string> line{title_of(configuration), windows_of(cell)};
    for (const NumberColumn& column : columns) line.push_back(number(cell, column));
    table.lines.push_back(std::move(line));
  }
  return table;
}

Table overview_table(std::span<const Row> rows) {
  const auto [cells, common_cells, columns] = overview_of(rows);
  Table table;
  table.caption =
      "Medians over the windows of a length that all methods solved (`common`). `solved`: windows "
      "that a method solved, of all. A method that solved none of a length is left out there";
  table.header = {"method", "frames", "solved", "common"};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::vector<std::string> line{cells[i].configuration,
                                  std::to_string(cells[i].frames),
                                  windows_of(cells[i]),
                                  std::to_string(common_cells[i].windows)};
    for (const NumberColumn& column : columns) line.push_back(number(common_cells[i], column));
    table.lines.push_back(std::move(line));
  }
  return table;
}

Table overview_numbers(std::span<const Row> rows) {
  const auto [cells, common_cells, columns] = overview_of(rows);
  Table table{.caption = {}, .header = {"method", "frames", "solved", "of"}, .lines = {}};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  table.header.emplace_back("common");
  for (const NumberColumn& column : columns)
    table.header.push_back(fmt::format("common {}", column.title));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    std::vector<std::string> line{cells[i].configuration,
                                  std::to_string(cells[i].frames),
                                  std::to_string(cells[i].ok),
                                  std::to_string(cells[i].windows)};
    for (const NumberColumn& column : columns) line.push_back(number(cells[i], column));
    line.push_back(std::to_string(common_cells[i].windows));
    for (const NumberColumn& column : columns) line.push_back(number(common_cells[i], column));
    std::ranges::replace(line, "-", "");
    table.lines.push_back(std::move(line));
  }
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
  std::vector<std::size_t> widths;
  for (const std::string& title : table.header) widths.push_back(title.size());
  for (const auto& line : table.lines)
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  const auto padded = [&](const std::vector<std::string>& line) {
    std::string text = fmt::format("{:<{}}", line.front(), widths.front());
    for (std::size_t i = 1; i < line.size(); ++i)
      text += fmt::format("  {:>{}}", line[i], widths[i]);
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
