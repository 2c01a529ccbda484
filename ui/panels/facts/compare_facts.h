// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/compared.h"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A number of the table: what is compared, and how.
struct ComparedColumn {
  const char* title;
  const char* meaning;  ///< with the unit; for the header's tooltip
  const char* unit;     ///< of `ComparedNumber::value`; empty: a count
};

/// Of the table of compared results, from the left; what they are called stands before them.
std::span<const ComparedColumn> compared_columns();

/// A cell of the table.
struct ComparedNumber {
  std::optional<double> value;
  std::string text;        ///< with its unit; a dash where it is not known
  std::string difference;  ///< to the first row: "+0.12° +63 %"; empty: there is none to tell
  /// How much better (to -1) or worse (to 1) than the first row: 1 where it is twice as large or
  /// more, -1 half as large or less. 0: alike, or neither is better.
  double worse = 0;
  std::string why_not;  ///< known; empty: it is
};

struct ComparedRow {
  Configuration configuration;
  Settings settings;                    ///< that make it the current one
  std::string status;                   ///< "ok", "failed", "computing"
  std::string reason;                   ///< why there is no result; empty: there is
  std::vector<ComparedNumber> numbers;  ///< one a column; empty while there is none
};

/// One row each, the first of which the others are compared to. Without `timings` the milliseconds
/// are dashes.
std::vector<ComparedRow> compared_rows(const std::vector<Compared>& results, bool timings);

/// By which column rows are put in order, and how.
struct TableOrder {
  int column = -1;  ///< of `compared_columns()`; -1: as they are
  bool descending = false;
};
/// The rows' indices in that order; what is not known comes last either way.
std::vector<std::size_t> in_order(const std::vector<ComparedRow>& rows, const TableOrder& order);

/// A header with units, and a line a row, for spreadsheets; what is not known is empty.
std::string to_csv(std::span<const ComparedRow> rows);

}  // namespace gpo
