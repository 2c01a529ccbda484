// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/benchmark/measure.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace gpo::bench {

/// Collects the results for the tables; Google Benchmark's own lines go to stderr.
class Results : public benchmark::ConsoleReporter {
 public:
  Results();
  void ReportRuns(const std::vector<Run>& runs) override;

  /// Returns the minimum of a benchmark's counter over the repetitions; nullopt if it did not run.
  std::optional<double> least(const std::string& benchmark, const std::string& counter) const;
  std::optional<double> ms(const std::string& benchmark) const { return least(benchmark, "ms"); }

 private:
  std::map<std::string, std::map<std::string, double>> least_;
};

/// Returns a / b; nullopt if one of them is missing.
std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b);

/// Estimates k of value ~ size^k by least squares.
class Exponent {
 public:
  void add(double size, const std::optional<double>& value);
  /// Returns nullopt for fewer than two values.
  std::optional<double> value() const;

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

/// Returns three significant digits without exponent, e.g. "0.0123", "4.56", "1230"; "-" for a
/// missing value or zero.
std::string cell(const std::optional<double>& value);
/// Returns the same without decimals.
std::string whole_number(const std::optional<double>& value);

/// Prints a line of a Markdown table.
void print_row(const std::vector<std::string>& cells);
/// Prints its first two lines: the first column is left-aligned, the others are right-aligned.
void print_head(const std::vector<std::string>& cells);

// Each file of benchmarks registers its own, and prints their tables of the README.

/// All methods on simulated windows, in one thread.
void register_method_benchmarks(const SharedWindows& windows);
void print_method_tables(const Results& results);

/// The parts of GPO, and growing windows, in one thread.
void register_part_benchmarks(const SharedWindows& windows);
void print_part_tables(const Results& results);

/// Front end, planes, gravity, live initialization and `evaluate`.
void register_stage_benchmarks();
void print_stage_tables(const Results& results);

/// Views off-screen at 1280x720.
void register_view_benchmarks();
void print_view_tables(const Results& results);

}  // namespace gpo::bench
