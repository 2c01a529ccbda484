// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "ui/look/palette.h"

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gpo {

/// One row of the results. An unknown value is a dash, and the tooltip says why.
struct ResultRow {
  std::string label = {};
  std::string value = {};    ///< with its unit
  std::string note = {};     ///< beside the value, dim
  std::string tooltip = {};  ///< explains the value
  Role color = Role::text;
};
inline ResultRow dash(std::string label, std::string why) {
  return {.label = std::move(label),
          .value = "\u2013",
          .tooltip = std::move(why),
          .color = Role::text_dim};
}

struct ResultGroup {
  std::string title;
  std::vector<ResultRow> rows;
};
constexpr const char* kVerdictTitle = "VERDICT";
constexpr const char* kTimeTitle = "TIME";

/// An error against ground truth.
struct Metric {
  const char *label, *meaning;
  const char* unit;
  std::optional<double> Evaluation::*value;
  std::string (*text)(double);
  bool needs_alignment = true;
};
std::span<const Metric> metrics();

/// Returns the facts for the menu bar: name, image size, frames and rate, gyroscope, ground truth,
/// calibration.
std::vector<std::string> recording_facts(const Recording& recording);

/// Returns the results of an inspection (null: none yet). Without `timings` milliseconds are
/// dashes. `chosen_side`: side of the cube [unit of the estimate]; 0: default.
std::vector<ResultGroup> result_groups(const Inspection* inspection,
                                       bool timings,
                                       double chosen_side = 0);

/// Returns what the verdict is based on, except for the normal uncertainty beside its badge.
ResultGroup verdict_group(const Inspection& inspection);

/// Returns the uncertainty of the result, estimated without ground truth.
ResultGroup uncertainty_group(const Inspection& inspection);

/// Returns the tooltip of the time line's bar at a frame of the recording: inliers, motion, and the
/// verdict on the window that ends there.
std::string bar_text(const Inspection& inspection, int frame);

}  // namespace gpo
