// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

namespace gpo {

/// The session as readable JSON: what is open, chosen and selected, without the data itself.
std::string session_text(const WorkbenchState& state);

/// Reads a session. Missing fields keep their defaults. Only `recording` names the recording;
/// `apply_recording` restores what depends on it. A recording that has moved together with `file`
/// is found next to it. Looks up `methods`. Throws InputError that names the file and the key.
SavedSession read_session(const fs::path& file, const MethodTable& methods = {});

/// Returns whether a file is a session, by its kind.
bool is_session(const fs::path& file);

/// Shows a recording that was opened: fits the window into it and shows the window's last frame. If
/// it is the current one with another camera, frame and bookmarks stay.
void apply_recording(WorkbenchState& state, std::shared_ptr<const Recording> recording);

// Files in $XDG_STATE_HOME. Errors of writing are ignored: they must not stop the user.

fs::path last_session_file();
void save_last_session(const WorkbenchState& state);

/// Saves the last session soon after each change, so that a killed program does not lose it.
class SessionSaver {
 public:
  /// Notes that the state may have changed: it is saved two seconds later.
  void note_change();
  /// Advances the time and saves the session if it is due and differs from the saved one.
  void advance(const WorkbenchState& state, double seconds);
  /// Returns the time until the session is saved; nullopt if it will not be.
  std::optional<double> seconds_left() const { return left_s_; }

 private:
  std::optional<double> left_s_;
  std::string saved_;
};
/// Recordings and sessions opened before that still exist, the last one first.
std::vector<fs::path> recent_files();
void remember_file(const fs::path& path);

/// Returns the window's size [screen units]; 0: unknown. Also restores theme, layout and text size.
cv::Size read_saved_window(WorkbenchState& state);
void save_window(cv::Size window, const WorkbenchState& state);

/// $XDG_CACHE_HOME/gpo-inspector, or ~/.cache/gpo-inspector; may not exist yet.
fs::path user_cache_folder();
/// $XDG_STATE_HOME/gpo-inspector, or ~/.local/state/gpo-inspector; may not exist yet.
fs::path user_state_folder();

}  // namespace gpo
