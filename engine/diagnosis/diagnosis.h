// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/diagnosis/evidence.h"
#include "engine/diagnosis/finding.h"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// Subject of a check, which is run where that is known.
enum class Of {
  recording,  ///< the same for all its windows; `info` runs these
  window,     ///< the window's tracks and rotations
  length,     ///< `Evidence::numbers` alone, which change as a window grows
  result,     ///< the result of a method
  inspection  ///< ground truth, requested points and settings of an inspection
};

template <>
struct ChoiceKeys<Of>
    : NamedKeys<"scope", "recording", "window", "growing window", "result", "inspection"> {};

/// A row of the table of checks.
struct Check {
  const char* key;
  const char* title;  ///< for the list of checks in help and README
  Of of;
  bool may_be_ignored;  ///< by `ignore_findings`
  /// Pure; empty if it lacks its inputs. Null: the remarks on its key.
  std::vector<Finding> (*look)(const Evidence& evidence);
};

/// Returns the checks in the order of the verdict's reasons.
std::span<const Check> checks();

/// Throws SettingError for a key of `ignore_findings` that no check has or that may not be ignored.
void check_ignored(std::span<const std::string> keys);

/// Runs the checks. Returns the findings, the heaviest level first, else in the table's order.
/// Ignored ones become notes.
std::vector<Finding> findings_of(const Evidence& evidence,
                                 std::initializer_list<Of> of,
                                 std::span<const std::string> ignored = {});

/// Sorts findings by level, the heaviest first, in their order.
void sort_by_level(std::vector<Finding>& findings);

/// Returns the numbers with the verdict: the level of the heaviest finding and its text. Without a
/// finding above a note the window is ready.
Verdict verdict_of(std::span<const Finding> findings, const Evidence& evidence);

/// Returns the verdicts on a window of 2, 3, ... frames as it grows, from the numbers of each
/// length and from those findings of the whole window that do not depend on its length.
std::vector<Verdict> growth_verdicts(std::span<const Verdict> numbers,
                                     std::span<const Finding> of_whole);

/// Returns the numbers of a growing window by the criterion of the whole window: each uncertainty
/// times the ratio of the whole window's to that of the last length, if it is above 1. Empty if one
/// of both has no uncertainty.
std::vector<Verdict> comparable_numbers(std::span<const Verdict> growth, const Verdict& whole);

/// Returns the result with the verdict; a degenerate one is a failure.
Initialization judged(Verdict verdict, Initialization result);

/// Adds the uncertainty and the verdict on the window to a method's result. The result of a
/// degenerate window becomes a failure.
Initialization assessed(const Method& method,
                        const Window& window,
                        Initialization result,
                        Lens lens = Lens::typical);

}  // namespace gpo
