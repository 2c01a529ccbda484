// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <filesystem>
#include <memory>
#include <string>

namespace gpo {

/// The session as readable JSON: what is open, chosen and selected, without the data itself.
std::string session_text(const WorkbenchState& state);

/// Reads a session. Fields that it does not have keep their defaults. Only `recording` names the
/// recording; `continue_session` restores what depends on it. If the recording has moved together
/// with `file`, it is found next to it. Methods are looked up in the table. Throws InputError that
/// names the file and the key.
SavedSession read_session(const std::filesystem::path& file, const MethodTable& methods = {});

/// Restores a session whose recording the state has just adopted.
void continue_session(WorkbenchState& state, const SavedSession& session);

/// Returns whether a file is a session, by its kind.
bool is_session(const std::filesystem::path& file);

/// Shows a recording that was opened: fits the window into it and shows the window's last frame. If
/// it is the current one with another camera, frame and bookmarks stay.
void apply_recording(WorkbenchState& state, std::shared_ptr<const Recording> recording);

}  // namespace gpo
