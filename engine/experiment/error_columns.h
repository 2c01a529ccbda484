// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/row.h"

#include <functional>
#include <set>

namespace gpo {

inline constexpr int kSignificant = -1;  // three significant digits

/// A column of numbers in a table.
struct NumberColumn {
  const char* title;
  std::vector<const char*> columns;  ///< columns of results.csv, whose medians are added
  double factor = 1;
  bool per_frame = false;
  int digits = kSignificant;  ///< after the decimal point
};

/// Formats three significant digits without an exponent: "0.0612", "3.98", "1235".
std::string significant(double value);
/// Formats a value in the unit of the column, without its `per_frame`.
std::string formatted(double value, const NumberColumn& column);

/// Returns PNE, ATE and PDE, and the errors of scale and gravity if these columns of results.csv
/// have values.
std::vector<NumberColumn> error_columns(const std::function<bool(const char* column)>& has_values);

std::set<int> lengths_in(std::span<const Row> rows);
/// Returns 10, 30 and 60 frames, or else the shortest, a middle and the longest length.
std::set<int> lengths_to_show(const std::set<int>& all);

}  // namespace gpo
