// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <filesystem>
#include <vector>

namespace gpo {

// Files that the program remembers between its starts, in $XDG_STATE_HOME. Write errors are
// ignored: they must not keep the user from working.

std::filesystem::path last_session_file();
/// Saves the session if a recording is open.
void save_last_session(const WorkbenchState& state);
/// Recordings and sessions opened before that still exist, the last one first.
std::vector<std::filesystem::path> recent_files();
void remember_file(const std::filesystem::path& path);

/// Size of the window at its last use.
struct SavedWindow {
  int width = 0;  ///< [screen units]; 0: unknown
  int height = 0;
};
/// Also restores theme, layout and text size in the state.
SavedWindow read_saved_window(WorkbenchState& state);
void save_window(const SavedWindow& window, const WorkbenchState& state);

/// $XDG_CACHE_HOME/gpo-inspector, or ~/.cache/gpo-inspector; may not exist yet.
std::filesystem::path user_cache_folder();
/// $XDG_STATE_HOME/gpo-inspector, or ~/.local/state/gpo-inspector; may not exist yet.
std::filesystem::path user_state_folder();

}  // namespace gpo
