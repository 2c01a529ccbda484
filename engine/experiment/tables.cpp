// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/tables.h"

#include "engine/experiment/summary.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr int kPaperFrames = 30;
constexpr std::array<int, 3> kOverviewFrames{10, 30, 60};

/// A column of numbers: what of results.csv, by which factor, and whether a frame's share of it.
struct NumberColumn {
  const char* title;
  std::vector<const char*> columns;  ///< whose medians are added
  double factor;
  bool per_frame;
  int digits;
};

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
  return fmt::format(
      "{:.{}f}", column.factor * sum / (column.per_frame ? cell.frames : 1), column.digits);
}

std::string title_of_key(const std::string& key) { return title_of(parse_configuration(key)); }

std::string windows_of(const Cell& cell) { return fmt::format("{}/{}", cell.ok, cell.windows); }

Table time_table(const std::vector<Cell>& cells, int frames) {
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
    std::vector<std::string> line{title_of_key(cell.configuration), windows_of(cell)};
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

/// Of each line's cells the widest.
std::vector<std::size_t> widths_of(const Table& table) {
  std::vector<std::size_t> widths;
  for (const std::string& title : table.header) widths.push_back(title.size());
  for (const auto& line : table.lines) {
    for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  return widths;
}

}  // namespace

Table running_time_table(std::span<const Row> rows) {
  const std::set<int> lengths = lengths_in(rows);
  const auto above = lengths.upper_bound(kPaperFrames);
  const int frames = above == lengths.begin() ? *above : *std::prev(above);
  Table table = time_table(summarize(rows), frames);
  table.caption =
      fmt::format("Running time of different initialization methods with {} frames", frames);
  if (frames != kPaperFrames) table.caption += fmt::format(" (no windows of {})", kPaperFrames);
  table.caption += ": medians over the solved windows, one thread";
  return table;
}

Table overview_table(std::span<const Row> rows) {
  const std::set<int> shown = lengths_to_show(lengths_in(rows));
  const std::vector<NumberColumn> columns{{"PNE [deg]", {"pne_deg"}, 1, false, 3},
                                          {"ATE [mm]", {"ate_m"}, 1e3, false, 2},
                                          {"PDE [mm]", {"pde_m"}, 1e3, false, 2}};
  Table table;
  table.caption = "Medians over the solved windows";
  table.header = {"method", "frames", "solved"};
  for (const NumberColumn& column : columns) table.header.emplace_back(column.title);
  for (const Cell& cell : summarize(rows)) {
    if (!shown.contains(cell.frames)) continue;
    std::vector<std::string> line{
        cell.configuration, std::to_string(cell.frames), windows_of(cell)};
    for (const NumberColumn& column : columns) line.push_back(number(cell, column));
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

}  // namespace gpo
