// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary.h"

#include "engine/experiment/error_columns.h"
#include "engine/files/text_file.h"
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using nlohmann::ordered_json;

const std::vector<std::string> kSummaryColumns = split(
    "rms_px,ate_m,pne_deg,pne_aligned_deg,pde_m,pne_bound_deg,scale_error_percent,"
    "gravity_error_deg,track_ms,ransac_ms,rotations_ms,initialize_ms,optimize_ms,total_ms",
    ',');

using WindowKey = std::tuple<std::string, int, int>;  // recording, start, frames
WindowKey window_of(const Row& row) {
  return {row.recording, row.settings.start, row.settings.frames};
}

std::vector<std::string> configurations_in(std::span<const Row> rows) {
  std::vector<std::string> keys;
  for (const Row& row : rows)
    if (std::ranges::find(keys, row.configuration) == keys.end()) keys.push_back(row.configuration);
  return keys;
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
    const auto& median = cell.values.at(name).median;
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

std::vector<NumberColumn> error_columns_of(const std::vector<Cell>& cells) {
  return error_columns([&](const char* column) {
    return std::ranges::any_of(cells,
                               [&](const Cell& cell) { return cell.values.at(column).count > 0; });
  });
}

/// Returns the number of windows of each length that all methods solved.
std::map<int, int> common_counts(std::span<const Row> common) {
  std::map<int, std::set<WindowKey>> windows;
  for (const Row& row : common) windows[row.settings.frames].insert(window_of(row));
  std::map<int, int> counts;
  for (const auto& [frames, keys] : windows) counts[frames] = static_cast<int>(keys.size());
  return counts;
}

/// Returns the median errors of a configuration at a length; "-" for unknown ones.
std::vector<std::string> medians_of(const std::vector<Cell>& cells,
                                    const Cell& like,
                                    const std::vector<NumberColumn>& columns) {
  const auto cell = std::ranges::find_if(cells, [&](const Cell& one) {
    return one.configuration == like.configuration && one.frames == like.frames;
  });
  std::vector<std::string> texts;
  for (const NumberColumn& column : columns)
    texts.push_back(cell == cells.end() ? "-" : number(*cell, column));
  return texts;
}

/// Cells of the lengths to show, from all windows and from those that all methods solved.
struct Overview {
  std::set<int> shown;  ///< numbers of frames
  std::vector<Cell> cells;
  std::vector<Cell> common_cells;
  std::vector<NumberColumn> columns;
  std::map<int, int> counts;  ///< common windows by number of frames
};

Overview overview_of(std::span<const Row> rows) {
  const std::vector<Row> common = on_common_windows(rows);
  Overview overview;
  overview.shown = lengths_to_show(lengths_in(rows));
  overview.cells = summarize(rows);
  overview.common_cells = summarize(common);
  overview.columns = error_columns_of(overview.cells);
  overview.counts = common_counts(common);
  for (const Cell& cell : overview.cells) overview.counts.try_emplace(cell.frames, 0);
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
    std::vector<Row> own(rows.begin(), rows.end());
    std::erase_if(own, [&](const Row& row) { return row.recording != recording.name; });
    recordings.push_back({{"recording", recording.name}, {"cells", cells_json(own)}});
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

}  // namespace

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
  for (const std::string& configuration : configurations_in(rows))
    for (const int frames : lengths_in(rows)) cells.push_back(cell_of(rows, configuration, frames));
  std::erase_if(cells, [](const Cell& cell) { return cell.windows == 0; });
  return cells;
}

std::vector<Row> on_common_windows(std::span<const Row> rows) {
  std::map<int, std::set<std::string>> solvers;  // configurations by length
  std::map<WindowKey, std::size_t> solved;       // number of configurations
  for (const Row& row : rows) {
    if (!row.ok()) continue;
    solvers[row.settings.frames].insert(row.configuration);
    ++solved[window_of(row)];
  }
  std::vector<Row> common(rows.begin(), rows.end());
  std::erase_if(common, [&](const Row& row) {
    return !row.ok() || solved[window_of(row)] != solvers[row.settings.frames].size();
  });
  return common;
}

std::vector<Row> rows_of(std::span<const Row> rows, std::span<const Configuration> configurations) {
  std::set<std::string> keys;
  for (const Configuration& configuration : configurations) keys.insert(key_of(configuration));
  std::vector<Row> chosen(rows.begin(), rows.end());
  std::erase_if(chosen, [&](const Row& row) { return !keys.contains(row.configuration); });
  return chosen;
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
  const auto [shown, cells, common_cells, columns, counts] = overview_of(rows);
  Table table;
  table.caption =
      "Medians over the windows of a length that all methods solved (`common`). `solved`: windows "
      "that a method solved, of all. A method that solved none of a length is left out there";
  table.header = {"method", "frames", "solved", "common"};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  for (const Cell& cell : cells) {
    if (!shown.contains(cell.frames)) continue;
    std::vector<std::string> line{cell.configuration,
                                  std::to_string(cell.frames),
                                  windows_of(cell),
                                  std::to_string(cell.ok > 0 ? counts.at(cell.frames) : 0)};
    for (const std::string& text : medians_of(common_cells, cell, columns)) line.push_back(text);
    table.lines.push_back(std::move(line));
  }
  return table;
}

Table overview_numbers(std::span<const Row> rows) {
  const auto [shown, cells, common_cells, columns, counts] = overview_of(rows);
  Table table{.caption = {}, .header = {"method", "frames", "solved", "of"}, .lines = {}};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  table.header.emplace_back("common");
  for (const NumberColumn& column : columns)
    table.header.push_back(fmt::format("common {}", column.title));
  for (const Cell& cell : cells) {
    if (!shown.contains(cell.frames)) continue;
    std::vector<std::string> line{cell.configuration,
                                  std::to_string(cell.frames),
                                  std::to_string(cell.ok),
                                  std::to_string(cell.windows)};
    for (const std::string& text : medians_of(cells, cell, columns)) line.push_back(text);
    line.push_back(std::to_string(cell.ok > 0 ? counts.at(cell.frames) : 0));
    for (const std::string& text : medians_of(common_cells, cell, columns)) line.push_back(text);
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
