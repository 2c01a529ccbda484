// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "ui/workbench/compared.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

struct ComparedColumn {
  const char* title;
  const char* meaning;  ///< for the tooltip of the header
  const char* unit;     ///< for `ComparedNumber::value`; empty: a count
};

/// Returns the columns of numbers, from the left; before them stand method and status.
std::span<const ComparedColumn> compared_columns();

struct ComparedNumber {
  std::optional<double> value;
  std::string text;        ///< with its unit; a dash if unknown
  std::string difference;  ///< from the first row: "+0.12° +63 %"; empty if there is none
  /// How much worse (positive) or better than the first row, as log2 of the ratio within -1..1; 0
  /// if neither is better.
  double worse = 0;
  std::string why_not;  ///< why the value is unknown; empty if it is known
};

struct ComparedRow {
  Configuration configuration;
  Settings settings;                         ///< that make the configuration the current one
  std::string status;                        ///< "ok", "failed", "computing", "not computed"
  std::string reason;                        ///< why there is no result; empty if there is one
  std::vector<ComparedNumber> numbers = {};  ///< one for each column; empty without an inspection
};

/// Returns one row for each result, compared with the first. Without `timings` milliseconds are
/// dashes.
std::vector<ComparedRow> compared_rows(const std::vector<Compared>& results, bool timings);

struct TableOrder {
  int column = -1;  ///< index in `compared_columns()`; -1: unsorted
  bool descending = false;
};
/// Returns the rows' indices in order; unknown values come last either way.
std::vector<std::size_t> in_order(const std::vector<ComparedRow>& rows, const TableOrder& order);

/// Returns a header with units and a line for each row; unknown values are empty.
std::string to_csv(std::span<const ComparedRow> rows);

/// The curves over the length of the window.
struct CurveFacts {
  std::vector<Configuration> configurations;  ///< also hidden ones
  Figure figure;     ///< ATE, PNE and PDE; without ground truth RMS and normal uncertainty
  std::string note;  ///< one line: why errors are missing; empty if they are not
  int done = 0;      ///< finished windows of the survey
  int of = 0;        ///< all of them; 0: the rows come from a file
};

/// Returns the curves of the open results.csv, or else of the compared configurations as far as
/// they are computed.
CurveFacts curve_facts(const WorkbenchState& state);

/// The same, computed again only if something that it depends on has changed.
class CachedCurveFacts {
 public:
  const CurveFacts& of(const WorkbenchState& state);

 private:
  std::shared_ptr<const SurveyResults> surveyed_;
  std::shared_ptr<const std::vector<Row>> experiment_;
  std::shared_ptr<const Inspection> inspection_;
  Settings settings_;
  std::vector<Configuration> compared_;
  std::vector<std::string> hidden_;
  CurveFacts facts_;
};

}  // namespace gpo
