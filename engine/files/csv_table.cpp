// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/csv_table.h"

#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cctype>

#include <fmt/ranges.h>

namespace gpo {

namespace {

constexpr std::size_t kMaxComments = 100;  // above the first row, as candidates for the header
constexpr std::size_t kLongestShown = 40;
constexpr std::string_view kBlanks = " \t";

std::string_view take_cell(std::string_view& rest, Separator separator) {
  const bool commas = separator == Separator::comma;
  const std::size_t end = commas ? rest.find(',') : rest.find_first_of(kBlanks);
  const std::string_view cell = trimmed(rest.substr(0, end));
  rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
  if (!commas) rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  return cell;
}

int cell_count(std::string_view row, Separator separator) {
  if (separator == Separator::comma) return 1 + static_cast<int>(std::ranges::count(row, ','));
  int count = 0;
  for (; !row.empty(); ++count) take_cell(row, separator);
  return count;
}

std::vector<std::string> cells_of(std::string_view row, Separator separator) {
  std::vector<std::string> cells;
  for (int left = cell_count(row, separator); left > 0; --left)
    cells.emplace_back(take_cell(row, separator));
  return cells;
}

std::string joined(std::vector<std::string> names) {
  std::ranges::replace(names, "", "...");
  return fmt::format("{}", fmt::join(names, ","));
}

std::string in_quotes(std::string_view text) {
  return fmt::format(
      "\"{}{}\"", text.substr(0, kLongestShown), text.size() > kLongestShown ? "..." : "");
}

/// Names of angular rates start like w, gyro, omega or rotation rate and end with the axis.
bool same_name(const std::string& header, const std::string& expected) {
  // "W_RS_S_x [rad s^-1]" -> "w_rs_s_x"
  const std::string name = lower_case(trimmed(header.substr(0, header.find_first_of("[("))));
  if (expected.empty()) return true;
  if (name.empty()) return false;
  if (expected == "timestamp") return name[0] == 't' || name.find("time") != std::string::npos;
  if (expected.size() > 2) return name.starts_with(expected) || expected.starts_with(name);
  if (expected[0] == 'w' && name == expected.substr(1)) return true;  // a file of rates alone
  const std::string first = expected[0] == 'w' ? "wgor" : expected.substr(0, 1);
  return first.find(name[0]) != std::string::npos && name.back() == expected.back();
}

/// Names the separator if a cell ends with another one: "0.1, 2, 3".
std::string separator_text(const CsvTable& table, std::string_view cell) {
  const bool other = cell.ends_with(',') || cell.ends_with(';');
  return other && table.separator == Separator::blanks ? ", separated by blanks" : "";
}

void check_header(const CsvTable& table, int line, const std::vector<std::string>& names) {
  for (std::size_t i = 0; i < names.size() && i < table.header.size(); ++i)
    if (!same_name(table.header[i], names[i]))
      csv_fail(table,
               line,
               fmt::format("column {} named {}", i + 1, in_quotes(table.header[i])),
               fmt::format("{} (columns {}{})",
                           in_quotes(names[i]),
                           joined(names),
                           separator_text(table, table.header[i])));
}

/// Names the separator if a row with too few columns seems to have another one.
std::string separator_text(const CsvRow& row, Separator separator) {
  const bool commas = separator == Separator::comma;
  if (row.text.find_first_of(commas ? ";\t " : ",;") == std::string_view::npos) return "";
  return commas ? " separated by commas" : " separated by blanks";
}

void check_count(const CsvTable& table,
                 const CsvRow& row,
                 const std::vector<std::string>& names,
                 CsvColumns columns,
                 bool truncated) {
  const int count = cell_count(row.text, table.separator);
  const int named = static_cast<int>(names.size());
  const int first = table.rows.empty() ? count : table.columns;
  const bool enough = columns == CsvColumns::exactly ? count == named : count >= named;
  if (enough && count == first) return;
  csv_fail(table,
           row.line,
           counted(count, "column") + (truncated ? " (the file seems truncated)" : ""),
           fmt::format("{}{}{} ({})",
                       columns == CsvColumns::at_least && !enough ? "at least " : "",
                       enough ? first : named,
                       enough ? "" : separator_text(row, table.separator),
                       joined(names)));
}

struct HeaderCandidate {
  std::string_view text;
  int line = 0;
  bool comment = false;
};

void take_header(CsvTable& table,
                 const std::vector<HeaderCandidate>& candidates,
                 const std::vector<std::string>& names) {
  for (auto candidate = candidates.rbegin(); candidate != candidates.rend(); ++candidate) {
    auto cells = cells_of(candidate->text, table.separator);
    const bool as_many = static_cast<int>(cells.size()) == table.columns;
    // A comment may by chance have as many words as there are columns.
    if (candidate->comment && !(as_many && same_name(cells[0], names[0]))) continue;
    table.header = std::move(cells);
    if (!as_many)
      csv_fail(table,
               candidate->line,
               fmt::format("{} names of columns", table.header.size()),
               fmt::format("{} as in the rows", table.columns));
    return check_header(table, candidate->line, names);
  }
}

/// Returns the decimal places from the header's unit to nanoseconds; nullopt if it names no unit.
std::optional<int> decimals_of_header(const CsvTable& table) {
  using Names = std::vector<std::string_view>;
  static const std::vector<std::pair<int, Names>> kUnits = {
      {9, {"s", "sec", "secs", "second", "seconds"}},
      {6, {"ms", "msec", "millis", "millisec", "millisecond", "milliseconds"}},
      {3, {"us", "usec", "micros", "microsec", "microsecond", "microseconds"}},
      {0, {"ns", "nsec", "nanos", "nanosec", "nanosecond", "nanoseconds"}}};
  if (table.header.empty()) return std::nullopt;
  std::string token;
  for (const char c : lower_case(table.header[0]) + " ") {
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) {
      token += c;
      continue;
    }
    for (const auto& [decimals, names] : kUnits)
      if (std::ranges::find(names, token) != names.end()) return decimals;
    token.clear();
  }
  return std::nullopt;
}

double median_step(const CsvTable& table) {
  constexpr std::size_t kRows = 1000;
  std::vector<double> steps;
  std::optional<double> previous;
  for (std::size_t i = 0; i < std::min(table.rows.size(), kRows); ++i) {
    const auto time = parse_number(csv_cell(table, table.rows[i], 0));
    if (time && previous) steps.push_back(*time - *previous);
    previous = time;
  }
  if (steps.empty()) return 0;
  std::ranges::nth_element(steps, steps.begin() + std::ssize(steps) / 2);
  return steps[steps.size() / 2];
}

int decimals_of_values(const CsvTable& table, TimeUnit otherwise) {
  constexpr double kSurelyNanoseconds = 1e16;
  constexpr double kShortestFrame = 2;  // [unit/1000]
  constexpr double kShortestSample = 0.2;
  if (otherwise == TimeUnit::seconds) return 9;
  if (otherwise == TimeUnit::nanoseconds) return 0;
  const auto first = parse_number(csv_cell(table, table.rows[0], 0));
  if (first && *first > kSurelyNanoseconds) return 0;
  const double step = median_step(table);
  double shortest = otherwise == TimeUnit::by_frame_rate ? kShortestFrame : kShortestSample;
  for (const int decimals : {9, 6, 3}) {
    if (step < shortest) return decimals;
    shortest *= 1e3;
  }
  return 0;
}

}  // namespace

void csv_fail(const CsvTable& table,
              int line,
              const std::string& found,
              const std::string& expected) {
  fail_at(place_in(table.file, line), found, expected);
}

CsvTable read_csv(const fs::path& file,
                  const std::vector<std::string>& names,
                  CsvColumns columns,
                  Separator separator) {
  const Budget budget(file);
  CsvTable table{.file = file,
                 .separator = separator,
                 .text = std::make_shared<const std::string>(read_file(file))};
  TextLines lines(*table.text);
  std::vector<HeaderCandidate> above;
  bool named = false;
  while (const auto next = lines.next()) {
    std::string_view line = *next;
    const int number = lines.number();
    const bool comment = line.starts_with('#');
    if (comment) line = trimmed(line.substr(1));
    if (line.empty() || (comment && !table.rows.empty())) continue;
    std::string_view rest = line;
    const bool names_columns =
        !comment && !named && table.rows.empty() && !parse_decimal(take_cell(rest, separator), 0);
    if (comment || names_columns) {
      named = named || names_columns;
      if (above.size() == kMaxComments) above.erase(above.begin());
      above.push_back({line, number, comment});
      continue;
    }
    const CsvRow row{number, line};
    check_count(table, row, names, columns, !lines.ended());
    if (table.rows.empty()) table.columns = cell_count(line, separator);
    spend_items(file);
    table.rows.push_back(row);
    if (table.rows.size() == 1) take_header(table, above, names);
  }
  if (table.rows.empty()) refuse(file, "found no rows, expected {}", joined(names));
  return table;
}

std::string_view csv_cell(const CsvTable& table, const CsvRow& row, int column) {
  check_stop();
  std::string_view rest = row.text;
  for (; column > 0; --column) take_cell(rest, table.separator);
  return take_cell(rest, table.separator);
}

bool is_measured(const CsvTable& table, const CsvRow& row, int first, int count) {
  for (int column = first; column < first + count; ++column)
    if (is_not_finite(csv_cell(table, row, column))) return false;
  return true;
}

int drop_unmeasured(CsvTable& table, int first, int count) {
  const int line = table.rows.front().line;
  const auto dropped = std::erase_if(
      table.rows, [&](const CsvRow& row) { return !is_measured(table, row, first, count); });
  if (table.rows.empty()) csv_fail(table, line, "no row of finite numbers", "some");
  return static_cast<int>(dropped);
}

int drop_repeats(CsvTable& table) {
  const auto same_time = [&](const CsvRow& a, const CsvRow& b) {
    return csv_cell(table, a, 0) == csv_cell(table, b, 0);
  };
  const auto repeats = std::unique(table.rows.begin(), table.rows.end(), same_time);
  const auto count = static_cast<int>(table.rows.end() - repeats);
  table.rows.erase(repeats, table.rows.end());
  return count;
}

double csv_number(const CsvTable& table, const CsvRow& row, int column) {
  const std::string_view cell = csv_cell(table, row, column);
  const auto value = parse_number(cell);
  if (!value)
    csv_fail(table, row.line, in_quotes(cell), "a finite number" + separator_text(table, cell));
  return *value;
}

Eigen::Vector3d csv_vector(const CsvTable& table, const CsvRow& row, int first) {
  return {csv_number(table, row, first),
          csv_number(table, row, first + 1),
          csv_number(table, row, first + 2)};
}

std::int64_t csv_integer(const CsvTable& table, const CsvRow& row, int column) {
  const std::string_view cell = csv_cell(table, row, column);
  const auto value = parse_integer(cell);
  if (!value) csv_fail(table, row.line, in_quotes(cell), "an integer");
  return *value;
}

std::vector<std::int64_t> csv_time_stamps(const CsvTable& table, TimeUnit otherwise) {
  const auto named = decimals_of_header(table);
  const int decimals = named ? *named : decimals_of_values(table, otherwise);
  std::vector<std::int64_t> times;
  times.reserve(table.rows.size());
  for (const auto& row : table.rows) {
    const std::string_view cell = csv_cell(table, row, 0);
    const auto time = parse_decimal(cell, decimals);
    if (!time)
      csv_fail(table, row.line, in_quotes(cell), "a time stamp" + separator_text(table, cell));
    const bool ascends = times.empty() || *time > times.back();
    if (!ascends && decimals == 0 && cell.find('.') != std::string_view::npos)
      csv_fail(table,
               row.line,
               fmt::format("time stamp {}, in seconds", cell.substr(0, kLongestShown)),
               "nanoseconds");
    if (!ascends)
      csv_fail(table,
               row.line,
               fmt::format("time stamp {}, {} the previous one",
                           cell.substr(0, kLongestShown),
                           *time == times.back() ? "equal to" : "earlier than"),
               "ascending time stamps");
    times.push_back(*time);
  }
  return times;
}

void read_quoted_csv(
    const fs::path& file,
    const std::function<void(int line, const std::vector<std::string>& cells)>& visit) {
  const std::string text = read_file(file);
  const auto fail = [&](int line, const std::string& found) {
    refuse(place_in(file, line), "found {}", found);
  };
  std::size_t at = 0;
  int line = 1;
  const auto quoted_cell = [&] {
    std::string cell;
    for (const int first_line = line;;) {
      const std::size_t quote = text.find('"', at + 1);
      if (quote == std::string::npos) fail(first_line, "a quote that does not end");
      const std::string_view part = std::string_view(text).substr(at + 1, quote - at - 1);
      line += static_cast<int>(std::ranges::count(part, '\n'));
      cell += part;
      at = quote + 1;
      if (at >= text.size() || text[at] != '"') break;
      cell += '"';  // doubled within a cell
    }
    if (at < text.size() && text[at] == '\r') ++at;
    return cell;
  };
  const auto plain_cell = [&] {
    const std::size_t end = std::min(text.find_first_of(",\n", at), text.size());
    std::string cell = text.substr(at, end - at);
    at = end;
    if (cell.ends_with('\r')) cell.pop_back();
    return cell;
  };
  while (at < text.size()) {
    check_stop();
    const int first_line = line;
    std::vector<std::string> cells;
    for (char after = ','; after == ',';) {
      cells.push_back(at < text.size() && text[at] == '"' ? quoted_cell() : plain_cell());
      after = at < text.size() ? text[at++] : '\n';
      if (after != ',' && after != '\n')
        fail(line, fmt::format("'{}' after a quoted cell, expected a comma", after));
    }
    ++line;
    visit(first_line, cells);
  }
}

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace gpo
