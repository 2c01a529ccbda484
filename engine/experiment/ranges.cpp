// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/ranges.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"

#include <set>
#include <sstream>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kMost = 1'000'000;  // frames

/// A number of frames, or nothing.
std::optional<int> count_in(const std::string& text) {
  const auto number = parse_integer(text);
  if (!number || *number < 0 || *number > kMost) return std::nullopt;
  return static_cast<int>(*number);
}

std::optional<Range> parse_range(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ':');) parts.push_back(part);
  if (parts.empty() || parts.size() > 3 || text.ends_with(':')) return std::nullopt;
  const auto first = count_in(parts[0]);
  const bool to_end = parts.size() > 1 && parts[1] == "end";
  const auto last = parts.size() > 1 ? count_in(parts[1]) : first;
  const auto step = parts.size() > 2 ? count_in(parts[2]) : 1;
  if (!first || !step || *step < 1) return std::nullopt;
  if (to_end) return Range{*first, std::nullopt, *step};
  if (!last || *last < *first) return std::nullopt;
  return Range{*first, last, *step};
}

}  // namespace

std::vector<Range> parse_ranges(const std::string& text, const std::string& name) {
  std::vector<Range> ranges;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, ',');) {
    const auto range = parse_range(part);
    if (!range) {
      throw SettingError(
          name, fmt::format("'{}', expected FIRST:LAST:STEP in whole numbers, e.g. 5:60:5", text));
    }
    ranges.push_back(*range);
  }
  if (ranges.empty()) throw SettingError(name, "is empty, e.g. 5:60:5");
  return ranges;
}

std::vector<int> numbers_in(const std::vector<Range>& ranges, int end) {
  std::set<int> numbers;
  for (const Range& range : ranges) {
    const int last = range.last.value_or(end);
    for (std::int64_t n = range.first; n <= last; n += range.step) {
      numbers.insert(static_cast<int>(n));
    }
  }
  return {numbers.begin(), numbers.end()};
}

}  // namespace gpo
