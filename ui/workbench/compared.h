// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "ui/workbench/state.h"

namespace gpo {

/// The result of one compared configuration in the current window.
struct Compared {
  Configuration configuration;  ///< names it, see `name_among_compared`
  Settings settings;
  std::shared_ptr<const Inspection> inspection = {};  ///< null: not computed yet
  std::string error = {};  ///< reason of failure, one line; empty: it is being computed
};

/// The inspection with its cube moved to a ray of the reference camera; unchanged without a ray.
std::shared_ptr<const Inspection> with_cube(std::shared_ptr<const Inspection> inspection,
                                            const std::optional<Eigen::Vector3d>& ray_c);

/// The configuration that names and colors settings: their difference from what all compared share.
Configuration name_among_compared(const WorkbenchState& state, const Settings& settings);

/// The settings of every configuration of `state.document.compared`, in that order. Settings that
/// none of them sets are those of `window`.
std::vector<Settings> compared_settings(const WorkbenchState& state, const Settings& window);

/// The results of `state.document.compared`, in that order; `flip` swaps the first two. All cubes
/// are on one ray of the reference camera: the user's, else that of the first result.
std::vector<Compared> compared_results(const WorkbenchState& state);

/// The results of `state.document.compared`, preceded by the current one if it is not among them.
std::vector<Compared> compared_with_current(const WorkbenchState& state);

/// The result that the image shows instead of the current one: of the first other compared
/// configuration. nullopt if `flip` is off or there is none.
std::optional<Compared> flipped_result(const WorkbenchState& state);

/// The window lengths of the curves, the longest first: `frames`, then multiples of five.
std::vector<int> curve_lengths(int frames);

/// The inspections that the open views need besides the current one: every compared configuration
/// in the current window and, if the curves are open, at shorter lengths.
std::vector<Settings> wanted_inspections(const WorkbenchState& state);

/// A result of the current window with its name and color.
struct ShownResult {
  std::string name;  ///< for people: "GPO without RANSAC"
  std::uint32_t rgb = 0;
  std::shared_ptr<const Inspection> inspection;
  bool current = false;  ///< the one that all views show
};

/// The current result first, then the computed compared ones of the same window. Empty before.
std::vector<ShownResult> shown_results(const WorkbenchState& state);

}  // namespace gpo
