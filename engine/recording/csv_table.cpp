// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/csv_table.h"

#include "engine/error.h"
#include "engine/recording/text_file.h"

#include <algorithm>
#include <cctype>
#include <optional>

#include <fmt/format.h>

namespace gpo {

namespace {

constexpr std::int64_t kLeastNanoseconds = 1'000'000'000'000;

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& name : names) {
    text += (text.empty() ? "" : ",") + (name.empty() ? std::string("...") : name);
  }
  return text;
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  return fmt::format("\"{}{}\"", text.substr(0, kLongest), text.size() > kLongest ? "..." : "");
}

/// "W_RS_S_x [rad s^-1]" -> "w_rs_s_x".
std::string plain_name(const std::string& name) {
  const std::string_view before_unit = std::string_view(name).substr(0, name.find_first_of("[("));
  return lower_case(trimmed(before_unit));
}

bool same_name(const std::string& header, const std::string& expected) {
  const std::string name = plain_name(header);
  if (expected.empty()) return true;
  if (name.empty()) return false;
  if (expected.size() <= 2) return name[0] == expected[0] && name.back() == expected.back();
  return name.starts_with(expected) || expected.starts_with(name);
}

void check_header(const CsvTable& table, int line, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size() && i < table.header.size(); ++i) {
    if (!same_name(table.header[i], names[i])) {
      csv_fail(table,
               line,
               "column " + std::to_string(i + 1) + " named " + in_quotes(table.header[i]),
               in_quotes(names[i]) + " (columns " + joined(names) + ")");
    }
  }
}

void check_count(const CsvTable& table,
                 const CsvRow& row,
                 const std::vector<std::string>& names,
                 CsvColumns columns,
                 bool cut) {
  const std::size_t first = table.rows.empty() ? row.cells.size() : table.rows[0].cells.size();
  const bool enough = columns == CsvColumns::exactly ? row.cells.size() == names.size()
                                                     : row.cells.size() >= names.size();
  if (enough && row.cells.size() == first) return;
  const std::size_t expected = enough ? first : names.size();
  csv_fail(table,
           row.line,
           std::to_string(row.cells.size()) + " columns" + (cut ? " (the file seems cut)" : ""),
           std::string(columns == CsvColumns::at_least && !enough ? "at least " : "") +
               std::to_string(expected) + " (" + joined(names) + ")");
}

/// The lines above the first row: which one of them names the columns.
struct HeaderCandidate {
  std::vector<std::string_view> cells;
  int line = 0;
  bool comment = false;
};

void take_header(CsvTable& table,
                 const std::vector<HeaderCandidate>& candidates,
                 const std::vector<std::string>& names) {
  for (auto candidate = candidates.rbegin(); candidate != candidates.rend(); ++candidate) {
    const auto& [cells, line, comment] = *candidate;
    if (comment && cells.size() != table.rows[0].cells.size()) continue;
    // A remark above a single column of numbers has as many cells as a header.
    if (comment && names.size() == 1 && !same_name(std::string(cells[0]), names[0])) continue;
    table.header.assign(cells.begin(), cells.end());
    if (cells.size() != table.rows[0].cells.size()) {
      csv_fail(table,
               line,
               std::to_string(cells.size()) + " names of columns",
               std::to_string(table.rows[0].cells.size()) + ", as many as the rows have");
    }
    return check_header(table, line, names);
  }
}

/// Whether the time stamps are in seconds (true) or nanoseconds, where the header tells.
std::optional<bool> header_says_seconds(const CsvTable& table) {
  if (table.header.empty()) return std::nullopt;
  std::string token;
  for (const char c : lower_case(table.header[0]) + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      token += c;
      continue;
    }
    if (token == "s" || token == "sec" || token == "seconds") return true;
    if (token == "ns" || token == "nsec" || token == "nanoseconds") return false;
    if (token == "ms" || token == "us" || token == "msec" || token == "usec") {
      throw InputError(table.file.string() + ": found time stamps in " + in_quotes(token) +
                       ", expected ns or s");
    }
    token.clear();
  }
  return std::nullopt;
}

}  // namespace

void csv_fail(const CsvTable& table,
              int line,
              const std::string& found,
              const std::string& expected) {
  throw InputError(table.file.string() + ":" + std::to_string(line) + ": found " + found +
                   ", expected " + expected);
}

CsvTable read_csv(const std::filesystem::path& file,
                  const std::vector<std::string>& names,
                  CsvColumns columns) {
  CsvTable table{file, std::make_shared<const std::string>(read_file(file)), {}, {}};
  std::string_view text = *table.text;
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // byte order mark
  std::vector<HeaderCandidate> above;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const bool last = end == std::string_view::npos;
    std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(last ? text.size() : end + 1);
    const bool comment = line.starts_with('#');
    if (comment) line = trimmed(line.substr(1));
    if (line.empty() || (comment && !table.rows.empty())) continue;
    CsvRow row{number, split(line)};
    if (comment || (table.rows.empty() && !parse_decimal(row.cells[0], 0) &&
                    std::none_of(above.begin(), above.end(), [](const auto& candidate) {
                      return !candidate.comment;
                    }))) {
      above.push_back({row.cells, number, comment});
      continue;
    }
    check_count(table, row, names, columns, last);
    table.rows.push_back(std::move(row));
    if (table.rows.size() == 1) take_header(table, above, names);
  }
  if (table.rows.empty()) {
    throw InputError(file.string() + ": found no rows, expected " + joined(names));
  }
  return table;
}

double csv_number(const CsvTable& table, const CsvRow& row, int column) {
  const auto value = parse_number(row.cells[column]);
  if (!value) csv_fail(table, row.line, in_quotes(row.cells[column]), "a finite number");
  return *value;
}

std::int64_t csv_integer(const CsvTable& table, const CsvRow& row, int column) {
  const auto value = parse_integer(row.cells[column]);
  if (!value) csv_fail(table, row.line, in_quotes(row.cells[column]), "an integer");
  return *value;
}

std::vector<std::int64_t> csv_time_stamps(const CsvTable& table, TimeUnit otherwise) {
  const auto first = parse_integer(table.rows[0].cells[0]);
  const bool large = first && *first > kLeastNanoseconds;
  const bool seconds =
      header_says_seconds(table).value_or(otherwise == TimeUnit::by_value && !large);
  std::vector<std::int64_t> times;
  times.reserve(table.rows.size());
  for (const auto& row : table.rows) {
    const auto time = parse_decimal(row.cells[0], seconds ? 9 : 0);
    if (!time) csv_fail(table, row.line, in_quotes(row.cells[0]), "a time stamp");
    if (!times.empty() && *time <= times.back()) {
      csv_fail(table,
               row.line,
               "time stamp " + std::string(row.cells[0]) +
                   (*time == times.back() ? ", a repetition of" : ", earlier than") +
                   " the one before it",
               "ascending time stamps");
    }
    times.push_back(*time);
  }
  return times;
}

}  // namespace gpo
