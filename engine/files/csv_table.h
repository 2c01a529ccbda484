// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/paths.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// An unparsed row; read it with `csv_cell`, `csv_number` or `csv_integer`.
struct CsvRow {
  int line;  ///< in the file, from 1
  std::string_view text;
};

enum class Separator { comma, blanks };

/// A file of rows with the same number of cells.
struct CsvTable {
  fs::path file;
  Separator separator = Separator::comma;
  std::shared_ptr<const std::string> text;  ///< storage of the rows
  std::vector<std::string> header = {};     ///< empty if the file has none
  std::vector<CsvRow> rows = {};            ///< at least one
  int columns = 0;
};

enum class CsvColumns { exactly, at_least };

/// The unit of time stamps if the header does not name one: by_frame_rate and by_sample_rate derive
/// it from the median step, as that of a camera (0.5 to 500 Hz) or an inertial sensor (10 to 5000
/// Hz).
enum class TimeUnit { seconds, nanoseconds, by_frame_rate, by_sample_rate };

/// An empty name is not checked, "wx" matches "w_RS_S_x" and "gyro_x". Throws InputError.
CsvTable read_csv(const fs::path& file,
                  const std::vector<std::string>& names,
                  CsvColumns columns,
                  Separator separator = Separator::comma);

std::string_view csv_cell(const CsvTable& table, const CsvRow& row, int column);
/// Returns whether no number of `count` columns from `first` on is "nan" or infinite, as of what
/// was not measured.
bool is_measured(const CsvTable& table, const CsvRow& row, int first, int count);
/// Removes the other rows and returns how many. Throws InputError if no row is left.
int drop_unmeasured(CsvTable& table, int first, int count);
/// Removes rows with the time stamp (column 0) of the row before; returns their number.
int drop_repeats(CsvTable& table);
/// Returns the finite number in a cell. Throws InputError with file and line.
double csv_number(const CsvTable& table, const CsvRow& row, int column);
/// Returns the same of three columns from `first` on.
Eigen::Vector3d csv_vector(const CsvTable& table, const CsvRow& row, int first);
std::int64_t csv_integer(const CsvTable& table, const CsvRow& row, int column);

/// Returns the first column as strictly ascending time stamps [ns], in the unit of the header
/// ("timestamp [ns]", "time_ms"), else in `otherwise`. Throws InputError.
std::vector<std::int64_t> csv_time_stamps(const CsvTable& table, TimeUnit otherwise);

/// Calls `visit` with the first line (from 1) and the cells of each row. Quoted cells may contain
/// commas and line breaks. Throws InputError with file and line for an unterminated quote, and for
/// one that is not followed by a comma.
void read_quoted_csv(
    const fs::path& file,
    const std::function<void(int line, const std::vector<std::string>& cells)>& visit);
/// Returns the text as a cell for `read_quoted_csv`, quoted if necessary.
std::string csv_quoted(const std::string& text);

/// Throws InputError "FILE:LINE: found FOUND, expected EXPECTED".
[[noreturn]] void csv_fail(const CsvTable& table,
                           int line,
                           const std::string& found,
                           const std::string& expected);

}  // namespace gpo
