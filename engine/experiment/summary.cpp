// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/summary.h"

#include "engine/experiment/figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>

namespace gpo {
namespace {

using nlohmann::ordered_json;

constexpr std::array<const char*, 12> kColumns{"rms_px",
                                               "ate_m",
                                               "pne_deg",
                                               "pne_aligned_deg",
                                               "pde_m",
                                               "pne_bound_deg",
                                               "track_ms",
                                               "ransac_ms",
                                               "rotations_ms",
                                               "initialize_ms",
                                               "optimize_ms",
                                               "total_ms"};

double quantile(const std::vector<double>& ascending, double q) {
  const double place = q * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return std::lerp(ascending[below], ascending[above], place - std::floor(place));
}

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
        if (value) values[name].push_back(*value);
      }
    });
  }
  for (const char* name : kColumns) cell.values[name] = distribution(values[name]);
  return cell;
}

ordered_json optional_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json cells_json(std::span<const Row> rows) {
  ordered_json cells = ordered_json::array();
  for (const Cell& cell : summarize(rows)) {
    ordered_json json = {{"configuration", cell.configuration},
                         {"frames", cell.frames},
                         {"windows", cell.windows},
                         {"ok", cell.ok},
                         {"failed", cell.windows - cell.ok}};
    for (const char* name : kColumns) {
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

ordered_json to_json(const Experiment& experiment, std::span<const Row> rows) {
  return {{"experiment", to_json(experiment)},
          {"all_windows", cells_json(rows)},
          {"by_recording", recordings_json(experiment, rows)},
          {"windows_that_all_solved", figures_json(experiment, rows)}};
}

}  // namespace gpo
