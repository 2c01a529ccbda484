// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <filesystem>
#include <vector>

namespace gpo {

// What is kept from one start of the program to the next, in the user's folder for states
// (XDG_STATE_HOME). Failures to write are silent: they must not keep anybody from working.

std::filesystem::path last_session_file();
/// Where a recording is open.
void save_last_session(const WorkbenchState& state);
/// Recordings and sessions that were opened, the last one first; those that are gone are left out.
std::vector<std::filesystem::path> recent_files();
void remember_file(const std::filesystem::path& path);

/// The window itself as it was left: theme, layout, size.
struct SavedWindow {
  int width = 0;  ///< [screen units]; 0: never kept
  int height = 0;
};
/// Into the state what of it belongs to the window rather than to a recording.
SavedWindow read_saved_window(WorkbenchState& state);
void save_window(const SavedWindow& window, const WorkbenchState& state);

/// The program's own folders in the user's home, after the XDG base directory specification; they
/// need not exist. What can be computed anew: $XDG_CACHE_HOME/gpo-inspector, or ~/.cache/...
std::filesystem::path user_cache_folder();
/// What is remembered: $XDG_STATE_HOME/gpo-inspector, or ~/.local/state/...
std::filesystem::path user_state_folder();

}  // namespace gpo
