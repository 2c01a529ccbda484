// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <algorithm>
#include <set>

namespace gpo {

/// Returns the rows for which `keep(row)` holds.
std::vector<Row> rows_where(std::span<const Row> rows, const auto& keep) {
  std::vector<Row> kept;
  std::ranges::copy_if(rows, std::back_inserter(kept), keep);
  return kept;
}

/// Returns the distinct values of a column in the order of the rows.
std::vector<std::string> unique_of(std::span<const Row> rows, std::string Row::*member);

std::set<int> lengths_in(std::span<const Row> rows);
/// Returns 10, 30 and 60 frames, or else the shortest, a middle and the longest length.
std::set<int> lengths_to_show(const std::set<int>& all);

/// Median and quartiles, linear between the order statistics (Hyndman and Fan's type 7).
struct Distribution {
  int count = 0;
  std::optional<double> lower, median, upper;  ///< nullopt if there are no values
};
Distribution distribution(std::vector<double> values);

/// A configuration on the windows of one length.
struct Cell {
  std::string configuration;  ///< key
  int frames = 0;
  int windows = 0;  ///< tried
  int ok = 0;       ///< solved
  /// The absolute values over the solved windows, by column of results.csv.
  std::map<std::string, Distribution> values = {};
};

/// Returns the cells by configuration, then length, without those that have no windows.
std::vector<Cell> summarize(std::span<const Row> rows);

/// Returns the cell of a configuration and a length; one without windows and values if there is
/// none.
Cell cell_or_empty(std::span<const Cell> cells, const std::string& configuration, int frames);
/// Returns the distribution of a column of results.csv; empty if the cell has no values.
Distribution distribution_of(const Cell& cell, const std::string& column);
/// Returns whether any cell has a value in this column of results.csv.
bool has_values(std::span<const Cell> cells, const std::string& column);

inline constexpr int kSignificant = -1;  // three significant digits

/// A column of numbers in a table.
struct NumberColumn {
  const char* title;
  std::vector<const char*> columns;  ///< columns of results.csv, whose medians are added
  double factor = 1;
  bool per_frame = false;
  int digits = kSignificant;  ///< after the decimal point
};

/// Formats a value in the unit of the column, without its `per_frame`; three significant digits
/// have no exponent: "0.0612", "3.98", "1235".
std::string formatted(double value, const NumberColumn& column);

/// Returns PNE, ATE and PDE, and the errors of scale and gravity if these have values.
std::vector<NumberColumn> error_columns(std::span<const Cell> cells);

/// Returns the rows whose window all configurations solved, so that methods are compared on the
/// same windows. A configuration that solved no window of a length is ignored for that length.
std::vector<Row> on_common_windows(std::span<const Row> rows);

/// Returns the rows of the configurations in their order.
std::vector<Row> rows_of(std::span<const Row> rows, std::span<const Configuration> configurations);

struct Table {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> lines;
};

/// Returns the paper's table of running times: medians over the solved windows of `timed_length`.
/// The caption says under which conditions they were measured.
Table running_time_table(std::span<const Row> rows);

/// Returns the number of solved windows and the median errors of each configuration at 10, 30 and
/// 60 frames, or else at the shortest, a middle and the longest length.
Table overview_table(std::span<const Row> rows);
/// Returns the same for programs: each cell is a number or empty.
Table overview_numbers(std::span<const Row> rows);

std::string to_markdown(const Table& table);
/// Returns the table without its caption.
std::string to_csv(const Table& table);
/// Returns aligned columns for a terminal, without the caption.
std::string to_text(const Table& table);

/// Returns summary.json: the experiment, the conditions of its times, and the cells of all windows,
/// of each recording, and of each figure's common windows.
nlohmann::ordered_json to_json(const Experiment& experiment, std::span<const Row> rows);

/// Returns ATE, PNE and PDE over the window length: median and quartiles over the windows that all
/// configurations solved (`on_common_windows`), and dotted the bound of the normal for the first
/// configuration. Ignores rows of other configurations.
Figure figure_over_length(std::span<const Row> rows, const FigurePlan& plan);

/// Returns the reprojection RMS over the length, for recordings without ground truth.
Figure figure_without_truth(std::span<const Row> rows, const FigurePlan& plan);

/// Returns all figures of an experiment, also those of metric scale and gravity if an accelerometer
/// was used.
std::vector<Figure> figures(std::span<const Row> rows,
                            const std::vector<Configuration>& configurations);

}  // namespace gpo
