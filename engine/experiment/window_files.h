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

/// An experiment's folder: `experiment.json` says what it is, `windows/` has a file for each window
/// that is finished. Files are written whole or not at all, so that an interrupt, of whatever kind,
/// costs no finished window and leaves none half written.
///
/// Makes the folder. Refuses one that holds another experiment, or something else
/// (`check_experiment_ folder`). One that asks the same of other recordings, or was made by another
/// version of the program, is taken over: returns the names of what differs; its windows will be
/// done again. Throws InputError.
std::vector<std::string> begin_experiment(const std::filesystem::path& folder,
                                          const Experiment& experiment);

/// Refuses a folder in which there is something, but no experiment. Throws InputError.
void check_experiment_folder(const std::filesystem::path& folder);

/// What a folder is about. Throws InputError.
Experiment read_experiment(const std::filesystem::path& folder, const MethodTable& methods = {});

/// The rows of one window, one a configuration, all of one of the experiment's recordings, start
/// and length, with what they depend on.
void save_window(const std::filesystem::path& folder,
                 const Experiment& experiment,
                 std::span<const Row> rows);

/// A window's file.
struct WindowFile {
  /// Nothing where the window is not finished, its file is not what `save_window` wrote, or
  /// `differs` is not empty.
  std::optional<std::vector<Row>> rows;
  std::vector<std::string> differs;  ///< in what it is of another experiment: "fx of desk"
};
WindowFile load_window(const std::filesystem::path& folder,
                       const Experiment& experiment,
                       const ExperimentTask& task,
                       int frames);

/// All rows in the order of the plan, each window from the first folder that has it. Throws an
/// InputError that names the windows that no folder has, or in what one is of another experiment.
std::vector<Row> collect_rows(const Experiment& experiment,
                              std::span<const std::filesystem::path> folders);

/// Makes of the folders of an experiment's shards the one that a single run would have made: its
/// definition and all its windows. Throws InputError where they, or windows in them, are of
/// different experiments (with the name of what differs) or a window is missing.
Experiment merge_experiments(std::span<const std::filesystem::path> folders,
                             const std::filesystem::path& output,
                             const MethodTable& methods = {});

}  // namespace gpo
