// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace gpo {

enum class Tone { plain, good, bad, dim };

/// One row of the results: what, how much with its unit, and an explanation. A value that is not
/// known is a dash, and the explanation says why.
struct ResultRow {
  std::string label;
  std::string value;
  std::string note;  ///< beside the value, dim: the bound
  std::string tooltip;
  Tone tone = Tone::plain;
};
/// The row of a value that is not known.
inline ResultRow dash(std::string label, std::string why) {
  return {std::move(label), "\u2013", "", std::move(why), Tone::dim};
}

struct ResultGroup {
  std::string title;
  std::vector<ResultRow> rows;
};

}  // namespace gpo
