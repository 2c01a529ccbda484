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

/// A row as it stands in the file; cells are cut out of it when they are asked for.
struct CsvRow {
  int line;  ///< in the file, from 1
  std::string_view text;
};

enum class Separator { comma, blanks };

/// A file of numbers and names in rows. Every row has the same number of cells.
struct CsvTable {
  std::filesystem::path file;
  Separator separator = Separator::comma;
  std::shared_ptr<const std::string> text;  ///< what the rows point into
  std::vector<std::string> header;          ///< empty where the file has none
  std::vector<CsvRow> rows;                 ///< at least one
  int columns = 0;
};

enum class CsvColumns { exactly, at_least };

/// In which unit time stamps are, where the header does not tell: by_frame_rate and by_sample_rate
/// tell it from their median distance, as that of a camera (0.5 to 500 Hz) or an inertial sensor
/// (10 to 5000 Hz).
enum class TimeUnit { seconds, nanoseconds, by_frame_rate, by_sample_rate };

/// Reads a table. `names` are the expected columns in their order; an empty name is not checked. A
/// header, if any, is the line above the first row, with or without '#'; other lines that begin
/// with '#' are comments. "w_RS_S_x [rad s^-1]" passes for "wx", and so does "gyro_x". Throws
/// InputError: no rows, wrong columns, a cut line, more than can be kept in memory.
CsvTable read_csv(const std::filesystem::path& file,
                  const std::vector<std::string>& names,
                  CsvColumns columns,
                  Separator separator = Separator::comma);

/// What stands in a column, without blanks around it.
std::string_view csv_cell(const CsvTable& table, const CsvRow& row, int column);
/// A finite number in a cell, or an InputError with file and line.
double csv_number(const CsvTable& table, const CsvRow& row, int column);
std::int64_t csv_integer(const CsvTable& table, const CsvRow& row, int column);

/// The first column as time stamps [ns], strictly ascending, in the unit that the header names
/// ("timestamp [ns]", "time_ms"), else in `otherwise`. Throws InputError.
std::vector<std::int64_t> csv_time_stamps(const CsvTable& table, TimeUnit otherwise);

/// A table of which some cells may be quoted, and then hold commas and lines' ends: row by row,
/// since others could not be cut into lines.
class QuotedCsv {
 public:
  struct Row {
    int line = 1;  ///< in which it begins, from 1
    std::vector<std::string> cells;
  };

  /// Throws InputError.
  explicit QuotedCsv(const std::filesystem::path& file);
  bool at_end() const { return at_ >= text_.size(); }
  /// Throws InputError with file and line where a quote does not end, or not before a comma.
  Row next();

 private:
  std::string cell();
  std::string quoted_cell();

  std::filesystem::path file_;
  std::string text_;
  std::size_t at_ = 0;
  int line_ = 1;
};
/// A cell of such a table: quoted where it holds a comma, a quote or a line's end.
std::string csv_quoted(const std::string& text);

[[noreturn]] void csv_fail(const CsvTable& table,
                           int line,
                           const std::string& found,
                           const std::string& expected);

}  // namespace gpo
