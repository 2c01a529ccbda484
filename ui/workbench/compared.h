// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "ui/workbench/state.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// One of the compared configurations in the current window, and what is known of it.
struct Compared {
  Configuration configuration;  ///< what it is called, see `called_among_compared`
  Settings settings;
  std::shared_ptr<const Inspection> inspection;  ///< null: not there, yet
  std::string error;  ///< why there will be none, one line; empty: it is being computed
};

/// What the compared configurations differ from: the current settings, but what any of them names
/// is by default.
Settings compared_base(const WorkbenchState& state);

/// What settings are called and colored as beside the compared ones: how they differ from
/// `compared_base`. What all have in common stands in the settings panel.
Configuration called_among_compared(const WorkbenchState& state, const Settings& settings);

/// The settings of every configuration of `state.document.compared`, in that order, in a window:
/// what none of them names is as the window has it.
std::vector<Settings> compared_settings(const WorkbenchState& state, const Settings& window);

/// Every configuration of `state.document.compared`, in that order; with `flip` the first two
/// change places. The cubes of all stand where one ray of the reference camera meets their planes:
/// where the user moved it, else where the first has it.
std::vector<Compared> compared_results(const WorkbenchState& state);

/// The same, and the current settings before the others where they are not among them.
std::vector<Compared> compared_with_current(const WorkbenchState& state);

/// The key of the configuration that the picture shows in place of the current one: the first
/// compared one that is another. Nothing where `flip` is off or there is none.
std::optional<Configuration> flipped(const WorkbenchState& state);

/// That configuration and what is known of it.
std::optional<Compared> flipped_result(const WorkbenchState& state);

/// The lengths of the windows whose results the curves show, the longest first: the window's own,
/// then multiples of five frames.
std::vector<int> curve_lengths(int frames);

/// The inspections that the open views ask for beside the current one: every compared configuration
/// in the current window, and with the curves open at shorter lengths, too.
std::vector<Settings> wanted_inspections(const WorkbenchState& state);

/// A result of the window that is shown, and how it is told from the others.
struct ShownResult {
  std::string name;  ///< for people: "GPO without RANSAC"
  std::uint32_t rgb = 0;
  std::shared_ptr<const Inspection> inspection;
  bool current = false;  ///< the one that the whole window shows
};

/// The current result first, then the compared ones in the same window that are computed by now.
/// Empty where nothing is inspected yet.
std::vector<ShownResult> shown_results(const WorkbenchState& state);

}  // namespace gpo
