// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

struct CsvRow {
  int line;  ///< in the file, from 1
  std::vector<std::string_view> cells;
};

/// A file of numbers and names, separated by commas. Every row has the same number of cells.
struct CsvTable {
  std::filesystem::path file;
  std::shared_ptr<const std::string> text;  ///< what the cells point into
  std::vector<std::string> header;          ///< empty where the file has none
  std::vector<CsvRow> rows;                 ///< at least one
};

enum class CsvColumns { exactly, at_least };
enum class TimeUnit { nanoseconds, by_value };

/// Reads a table. `names` are the expected columns in their order; an empty name is not checked. A
/// header, if any, is the line above the first row, with or without '#'; other lines that begin
/// with '#' are comments. "w_RS_S_x [rad s^-1]" passes for "wx". Throws InputError: no rows, wrong
/// columns, a cut line.
CsvTable read_csv(const std::filesystem::path& file,
                  const std::vector<std::string>& names,
                  CsvColumns columns);

/// A finite number in a cell, or an InputError with file and line.
double csv_number(const CsvTable& table, const CsvRow& row, int column);
std::int64_t csv_integer(const CsvTable& table, const CsvRow& row, int column);

/// The first column as time stamps [ns], strictly ascending, in the unit that the header names
/// ("timestamp [ns]", "timestamp_s"). Where it names none: `otherwise`; by_value means nanoseconds
/// for integers above 1e12, else seconds. Throws InputError.
std::vector<std::int64_t> csv_time_stamps(const CsvTable& table, TimeUnit otherwise);

[[noreturn]] void csv_fail(const CsvTable& table,
                           int line,
                           const std::string& found,
                           const std::string& expected);

}  // namespace gpo
