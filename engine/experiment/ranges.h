// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Whole numbers from `first` to `last`, both included, every `step`-th.
struct Range {
  int first = 0;
  std::optional<int> last;  ///< nothing: `end`, known once there is a recording
  int step = 1;

  bool operator==(const Range&) const = default;
};

/// Reads `A`, `A:B`, `A:B:STEP`, and lists of these with commas; B may be `end`. `name` is named
/// in the InputError.
std::vector<Range> parse_ranges(const std::string& text, const std::string& name);

/// The numbers in all of the ranges, ascending, each once; `end` stands for `end`.
std::vector<int> numbers_in(const std::vector<Range>& ranges, int end);

}  // namespace gpo
