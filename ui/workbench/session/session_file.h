// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <filesystem>
#include <string>

namespace gpo {

/// What was open, chosen and selected, as a file keeps it: readable JSON, apart from the data.
std::string session_text(const WorkbenchState& state);

/// Reads what `session_text` wrote. What a session does not name stays at its default. The
/// recording is named by `session.path` alone; what depends on it waits for `continue_session`.
/// Throws InputError that names the file and the key. `file` is for messages and for recordings
/// that have moved together with it. Methods are found in the table.
SavedSession read_session(const std::filesystem::path& file, const MethodTable& methods = {});

/// Takes over a session whose recording the state has just adopted.
void continue_session(WorkbenchState& state, const SavedSession& session);

/// Whether a file is a session, by its first lines.
bool is_session(const std::filesystem::path& file);

}  // namespace gpo
