// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

namespace gpo::bench {

/// Google Benchmark's own lines go to stderr; what the tables are made of is kept.
class Results : public benchmark::ConsoleReporter {
 public:
  Results();
  void ReportRuns(const std::vector<Run>& runs) override;

  /// The least of a benchmark's counter over the repetitions; nothing where it did not run.
  std::optional<double> least(const std::string& benchmark, const std::string& counter) const;

 private:
  std::map<std::string, std::map<std::string, double>> least_;
};

/// Nothing where one of them is.
std::optional<double> ratio(const std::optional<double>& a, const std::optional<double>& b);

/// k of value ~ size^k by least squares; nothing of less than two.
class Exponent {
 public:
  void add(double size, const std::optional<double>& value);
  std::optional<double> value() const;

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

/// Three significant digits without exponent, e.g. "0.0123", "4.56", "1230"; nothing or zero: "-".
std::string cell(const std::optional<double>& value);
/// The same without digits after the point.
std::string whole_number(const std::optional<double>& value);

/// A line of a Markdown table.
void print_row(const std::vector<std::string>& cells);
/// Its two first lines: the first column to the left, the others to the right.
void print_head(const std::vector<std::string>& cells);

}  // namespace gpo::bench
