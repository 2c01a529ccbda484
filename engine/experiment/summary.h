// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/experiment/row.h"

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Median and quartiles, linear between the order statistics (Hyndman and Fan's type 7).
struct Distribution {
  int count = 0;  ///< of the values; the others are nothing where it is 0
  std::optional<double> lower, median, upper;
};
Distribution distribution(std::vector<double> values);

/// The columns of results.csv that are summarized: by their size, whatever the sign of an error.
inline constexpr std::array<const char*, 14> kSummaryColumns{"rms_px",
                                                             "ate_m",
                                                             "pne_deg",
                                                             "pne_aligned_deg",
                                                             "pde_m",
                                                             "pne_bound_deg",
                                                             "scale_error_percent",
                                                             "gravity_error_deg",
                                                             "track_ms",
                                                             "ransac_ms",
                                                             "rotations_ms",
                                                             "initialize_ms",
                                                             "optimize_ms",
                                                             "total_ms"};

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

}  // namespace gpo
