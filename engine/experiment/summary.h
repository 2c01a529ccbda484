// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace gpo {

/// Median and quartiles, linear between the order statistics (Hyndman and Fan's type 7).
struct Distribution {
  int count = 0;  ///< of the values; the others are nothing where it is 0
  std::optional<double> lower, median, upper;
};
Distribution distribution(std::vector<double> values);

/// A configuration on the windows of one length.
struct Cell {
  std::string configuration;  ///< key
  int frames = 0;
  int windows = 0;  ///< tried
  int ok = 0;       ///< solved
  std::map<std::string, Distribution> values =
      {};  ///< by column, over the solved windows where known
};

/// One cell a length and configuration, in that order; those without windows are left out.
std::vector<Cell> summarize(std::span<const Row> rows);

/// The rows whose window every configuration solved, so that methods are compared on the same
/// windows. A configuration that solved no window of a length has no say in that length: its rows
/// are left out.
std::vector<Row> on_common_windows(std::span<const Row> rows);

/// The rows of the configurations, in the rows' order.
std::vector<Row> rows_of(std::span<const Row> rows, std::span<const Configuration> configurations);

/// summary.json: the experiment; per configuration and length over all windows; the same for each
/// recording; and for each of the figures over the windows that all of its configurations solved.
nlohmann::ordered_json to_json(const Experiment& experiment, std::span<const Row> rows);

}  // namespace gpo
