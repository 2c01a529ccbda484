// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

namespace gpo {

/// Median and quartiles, linear between the order statistics (Hyndman and Fan's type 7).
struct Distribution {
  int count = 0;
  std::optional<double> lower, median, upper;  ///< nullopt if there are no values
};
Distribution distribution(std::vector<double> values);

struct Cell {
  std::string configuration;  ///< key
  int frames = 0;
  int windows = 0;  ///< tried
  int ok = 0;       ///< solved
  /// The absolute values over the solved windows, by column of results.csv.
  std::map<std::string, Distribution> values = {};
};

std::vector<Cell> summarize(std::span<const Row> rows);

/// Returns the rows whose window all configurations solved that solved any window of its length.
std::vector<Row> on_common_windows(std::span<const Row> rows);

std::vector<Row> rows_of(std::span<const Row> rows, std::span<const Configuration> configurations);

struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> lines;
};

/// Returns the paper's table of running times: medians over the solved windows of `timed_length`.
Table running_time_table(std::span<const Row> rows);

/// Solved windows and median errors at 10, 30 and 60 frames, else at three of the lengths.
Table overview_table(std::span<const Row> rows);
Table overview_numbers(std::span<const Row> rows);

std::string to_markdown(const Table& table);
std::string to_csv(const Table& table);
std::string to_text(const Table& table);

nlohmann::ordered_json to_json(const Experiment& experiment, std::span<const Row> rows);

/// ATE, PNE and PDE over the window length on common windows; dotted: the first one's bound.
Figure figure_over_length(std::span<const Row> rows, const FigurePlan& plan);

Figure figure_without_truth(std::span<const Row> rows, const FigurePlan& plan);

std::vector<Figure> figures(std::span<const Row> rows,
                            const std::vector<Configuration>& configurations);

}  // namespace gpo
