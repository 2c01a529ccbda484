// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/row.h"

#include <filesystem>
#include <vector>

namespace gpo {

/// Whether a file is a results.csv of `evaluate`, by its first line.
bool is_results(const std::filesystem::path& file);

/// Its rows. Columns are found by their names: those that it does not have are unknown in every
/// row, others than `visit_row` names are passed over. Throws InputError with file and line.
std::vector<Row> read_results(const std::filesystem::path& file, const MethodTable& methods = {});

}  // namespace gpo
