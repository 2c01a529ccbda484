// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary.h"

#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

namespace gpo {
namespace {

using WindowKey = std::tuple<std::string, int, int>;  // recording, start, frames
WindowKey window_of(const Row& row) {
  return {row.recording, row.settings.start, row.settings.frames};
}

/// In the order of their first rows.
std::vector<std::string> configurations_in(std::span<const Row> rows) {
  std::vector<std::string> keys;
  for (const Row& row : rows) {
    if (std::ranges::find(keys, row.configuration) == keys.end()) keys.push_back(row.configuration);
  }
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
      if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::optional<double>>) {
        if (value) values[name].push_back(std::abs(*value));
      }
    });
  }
  for (const char* name : kSummaryColumns) cell.values[name] = distribution(values[name]);
  return cell;
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
  std::set<int> lengths;
  for (const Row& row : rows) lengths.insert(row.settings.frames);
  std::vector<Cell> cells;
  for (const std::string& configuration : configurations_in(rows)) {
    for (const int frames : lengths) cells.push_back(cell_of(rows, configuration, frames));
  }
  std::erase_if(cells, [](const Cell& cell) { return cell.windows == 0; });
  return cells;
}

std::vector<Row> on_common_windows(std::span<const Row> rows) {
  std::map<int, std::set<std::string>> solvers;  // configurations by length
  std::map<WindowKey, std::size_t> solved;       // by how many
  for (const Row& row : rows) {
    if (!row.ok()) continue;
    solvers[row.settings.frames].insert(row.configuration);
    ++solved[window_of(row)];
  }
  std::vector<Row> common;
  std::ranges::copy_if(rows, std::back_inserter(common), [&](const Row& row) {
    return row.ok() && solved[window_of(row)] == solvers[row.settings.frames].size();
  });
  return common;
}

std::vector<Row> rows_of(std::span<const Row> rows, std::span<const Configuration> configurations) {
  std::set<std::string> keys;
  for (const Configuration& configuration : configurations) keys.insert(key_of(configuration));
  std::vector<Row> chosen;
  std::ranges::copy_if(rows, std::back_inserter(chosen), [&](const Row& row) {
    return keys.contains(row.configuration);
  });
  return chosen;
}

}  // namespace gpo
