// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/numbers.h"

#include <string>
#include <vector>

namespace gpo {

/// A recording in a few words, for the menu bar: name, picture size, frames and rate, gyroscope,
/// truth.
std::vector<std::string> recording_facts(const Recording& recording);

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
ResultRow dash(std::string label, std::string why);

struct ResultGroup {
  std::string title;
  std::vector<ResultRow> rows;
};

/// The results of an inspection, or of none (null). Without `timings` the milliseconds are dashes.
std::vector<ResultGroup> result_groups(const Inspection* inspection, bool timings);

}  // namespace gpo
