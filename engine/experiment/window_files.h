// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/experiment.h"
#include "engine/experiment/row.h"

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// An experiment's folder: `experiment.json` says what it is, `windows/` has a file for each window
/// that is finished. Files are written whole or not at all, so that an interrupt, of whatever kind,
/// costs no finished window and leaves none half written.
///
/// Makes the folder, or refuses one that holds another experiment. Throws InputError.
void begin_experiment(const std::filesystem::path& folder, const Experiment& experiment);

/// What a folder is about. Throws InputError.
Experiment read_experiment(const std::filesystem::path& folder);

/// The rows of one window, one a configuration, all of one recording, start and length.
void save_window(const std::filesystem::path& folder, std::span<const Row> rows);

/// Nothing where the window is not finished, or its file is not what `save_window` wrote.
std::optional<std::vector<Row>> load_window(const std::filesystem::path& folder,
                                            const Experiment& experiment,
                                            const ExperimentTask& task,
                                            int frames);

/// All rows in the order of the plan, each window from the first folder that has it. Throws an
/// InputError that names the windows that no folder has.
std::vector<Row> collect_rows(const Experiment& experiment,
                              std::span<const std::filesystem::path> folders);

/// Makes of the folders of an experiment's shards the one that a single run would have made: its
/// definition and all its windows. Throws InputError where they are of different experiments or a
/// window is missing.
Experiment merge_experiments(std::span<const std::filesystem::path> folders,
                             const std::filesystem::path& output);

}  // namespace gpo
