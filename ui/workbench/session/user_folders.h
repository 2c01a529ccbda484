// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace gpo {

/// The program's own folders in the user's home, after the XDG base directory specification; they
/// need not exist. What can be computed anew: $XDG_CACHE_HOME/gpo-inspector, or ~/.cache/...
std::filesystem::path user_cache_folder();
/// What is remembered: $XDG_STATE_HOME/gpo-inspector, or ~/.local/state/...
std::filesystem::path user_state_folder();

}  // namespace gpo
