// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Creates the folder of an experiment: `experiment.json` is its plan, `windows/` has one file for
/// each finished window. Files are written as a whole, so an interruption loses no finished window.
///
/// Throws InputError if the folder has another plan or other files. Reuses a folder whose plan
/// equals but whose recordings or program version differ: returns the names of what differs; the
/// windows will be redone.
std::vector<std::string> begin_experiment(const std::filesystem::path& folder,
                                          const Experiment& experiment);

/// Throws InputError if the folder has files but no experiment.
void check_experiment_folder(const std::filesystem::path& folder);

/// Throws InputError.
Experiment read_experiment(const std::filesystem::path& folder, const MethodTable& methods = {});

/// Saves the rows of one window, one per configuration.
void save_window(const std::filesystem::path& folder,
                 const Experiment& experiment,
                 std::span<const Row> rows);

struct WindowFile {
  std::optional<std::vector<Row>> rows;  ///< nullopt if missing, incomplete, broken or different
  std::vector<std::string> differs;      ///< names of what another experiment has: "fx of desk"
};
WindowFile load_window(const std::filesystem::path& folder,
                       const Experiment& experiment,
                       const ExperimentTask& task,
                       int frames);

/// Returns all rows in the order of the plan, each window from the first folder that has it. Throws
/// an InputError that names missing windows or what differs in one of another experiment.
std::vector<Row> collect_rows(const Experiment& experiment,
                              std::span<const std::filesystem::path> folders);

/// Merges the folders of shards into the folder that a single run would have written. Throws
/// InputError if they differ in their experiments or a window is missing.
Experiment merge_experiments(std::span<const std::filesystem::path> folders,
                             const std::filesystem::path& output,
                             const MethodTable& methods = {});

}  // namespace gpo
