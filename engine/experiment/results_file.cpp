// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/results_file.h"

#include "engine/base/error.h"
#include "engine/experiment/configuration.h"
#include "engine/files/csv_table.h"

#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr std::array kNeeded{"recording", "configuration", "start", "frames", "status"};
constexpr std::size_t kMostRows = 500'000;
constexpr const char* kBegin = "recording,configuration,";

void check(const Row& row, const MethodTable& methods) {
  if (row.status != "ok" && row.status != "failed")
    throw InputError(fmt::format("status: found '{}', expected ok or failed", row.status));
  if (key_of(parse_configuration(row.configuration, methods)) != row.configuration)
    throw InputError(
        fmt::format("configuration: '{}' is not how it is written", row.configuration));
}

Row row_of(const QuotedCsv::Row& line,
           const std::vector<std::string>& names,
           const MethodTable& methods) {
  Row row = row_from(methods, [&](const char* name) -> std::optional<std::string> {
    const auto column = std::ranges::find(names, name);
    if (column == names.end()) return std::nullopt;
    return line.cells[column - names.begin()];
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
  QuotedCsv text(file);
  const std::vector<std::string> names = text.next().cells;
  for (const char* needed : kNeeded)
    if (std::ranges::find(names, needed) == names.end())
      throw InputError(fmt::format("{}:1: no column is called {}", file.string(), needed));
  std::vector<Row> rows;
  while (!text.at_end()) {
    const QuotedCsv::Row line = text.next();
    if (rows.size() == kMostRows) {
      throw InputError(fmt::format(
          "{}:{}: found more than {} rows, expected fewer", file.string(), line.line, kMostRows));
    }
    if (line.cells.size() == 1 && line.cells[0].empty()) continue;
    if (line.cells.size() != names.size())
      throw InputError(fmt::format("{}:{}: found {} cells, expected {} as in the header",
                                   file.string(),
                                   line.line,
                                   line.cells.size(),
                                   names.size()));
    try {
      rows.push_back(row_of(line, names, methods));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}:{}: {}", file.string(), line.line, error.what()));
    }
  }
  if (rows.empty()) throw InputError(fmt::format("{}: found no rows of results", file.string()));
  return rows;
}

}  // namespace gpo
