// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/results_file.h"

#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::array kNeeded{"recording", "configuration", "start", "frames", "status"};
constexpr std::size_t kMostRows = 500'000;
constexpr const char* kBegin = "recording,configuration,";

/// Cells of one row, and where it begins.
struct Line {
  int number = 1;  ///< in the file, from 1
  std::vector<std::string> cells;
};

/// Takes rows off a text whose cells may be quoted, and then hold commas and lines' ends.
class CsvText {
 public:
  CsvText(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {}

  bool at_end() const { return at_ >= text_.size(); }

  Line next() {
    Line line{line_, {}};
    while (true) {
      line.cells.push_back(cell());
      const char after = at_end() ? '\n' : text_[at_++];
      if (after == ',') continue;
      if (after == '\n') break;
      throw InputError(fmt::format(
          "{}:{}: found '{}' after a quoted cell, expected a comma", file_, line_, after));
    }
    ++line_;
    return line;
  }

 private:
  std::string cell() {
    if (!at_end() && text_[at_] == '"') return quoted();
    const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
    std::string plain = text_.substr(at_, end - at_);
    at_ = end;
    if (!plain.empty() && plain.back() == '\r') plain.pop_back();
    return plain;
  }

  /// From its first quote to its last; a quote within is written twice.
  std::string quoted() {
    const int first_line = line_;
    std::string cell;
    for (++at_; !at_end(); ++at_) {
      if (text_[at_] == '\n') ++line_;
      if (text_[at_] != '"') {
        cell += text_[at_];
        continue;
      }
      ++at_;
      if (at_end() || text_[at_] != '"') {
        if (!at_end() && text_[at_] == '\r') ++at_;
        return cell;
      }
      cell += '"';
    }
    throw InputError(fmt::format("{}:{}: found a quote that does not end", file_, first_line));
  }

  std::string file_, text_;
  std::size_t at_ = 0;
  int line_ = 1;
};

template <class Number>
Number number_of(const std::string& text, const char* expected) {
  if constexpr (std::is_floating_point_v<Number>) {
    if (const auto value = parse_number(text)) return *value;
  } else if (const auto value = parse_integer(text)) {
    if (std::in_range<Number>(*value)) return static_cast<Number>(*value);
  }
  throw InputError(fmt::format("found '{}', expected {}", text, expected));
}

template <class Value>
void read_value(const std::string& text, const MethodTable& methods, Value& value) {
  if constexpr (OfASetting<Value>) {
    read_setting_cell(value.settings, value.setting, text, methods);
  } else if constexpr (is_optional<Value>) {
    value.reset();
    if (!text.empty()) read_value(text, methods, value.emplace());
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = text;
  } else {
    value = number_of<Value>(
        text, std::is_floating_point_v<Value> ? "a number" : "a whole number in its range");
  }
}

void check(const Row& row, const MethodTable& methods) {
  if (row.status != "ok" && row.status != "failed")
    throw InputError(fmt::format("status: found '{}', expected ok or failed", row.status));
  if (key_of(parse_configuration(row.configuration, methods)) != row.configuration)
    throw InputError(
        fmt::format("configuration: '{}' is not how it is written", row.configuration));
}

Row row_of(const Line& line, const std::vector<std::string>& names, const MethodTable& methods) {
  Row row;
  visit_row(row, [&](const char* name, auto& value) {
    const auto column = std::ranges::find(names, name);
    if (column == names.end()) return;
    try {
      read_value(line.cells[column - names.begin()], methods, value);
    } catch (const SettingError&) {
      throw;  // names itself
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", name, error.what()));
    }
  });
  check(row, methods);
  return row;
}

}  // namespace

bool is_results(const std::filesystem::path& file) {
  std::error_code none;
  if (file.extension() != ".csv" || !std::filesystem::is_regular_file(file, none)) return false;
  std::string begin(std::char_traits<char>::length(kBegin), ' ');
  std::ifstream(file).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  return begin == kBegin;
}

std::vector<Row> read_results(const std::filesystem::path& file, const MethodTable& methods) {
  CsvText text(file.string(), read_file(file));
  const std::vector<std::string> names = text.next().cells;
  for (const char* needed : kNeeded)
    if (std::ranges::find(names, needed) == names.end())
      throw InputError(fmt::format("{}:1: no column is called {}", file.string(), needed));
  std::vector<Row> rows;
  while (!text.at_end()) {
    const Line line = text.next();
    if (rows.size() == kMostRows) {
      throw InputError(fmt::format(
          "{}:{}: found more than {} rows, expected fewer", file.string(), line.number, kMostRows));
    }
    if (line.cells.size() == 1 && line.cells[0].empty()) continue;
    if (line.cells.size() != names.size())
      throw InputError(fmt::format("{}:{}: found {} cells, expected {} as in the header",
                                   file.string(),
                                   line.number,
                                   line.cells.size(),
                                   names.size()));
    try {
      rows.push_back(row_of(line, names, methods));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", file.string(), line.number, error.what()));
    }
  }
  if (rows.empty()) throw InputError(fmt::format("{}: found no rows of results", file.string()));
  return rows;
}

}  // namespace gpo
