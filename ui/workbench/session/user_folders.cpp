// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/user_folders.h"

#include <cstdlib>

namespace gpo {

namespace {

namespace fs = std::filesystem;

fs::path user_folder(const char* variable, const fs::path& in_home) {
  constexpr const char* kName = "gpo-inspector";
  const char* folder = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): nobody sets it
  const char* home = std::getenv("HOME");      // NOLINT(concurrency-mt-unsafe): nobody sets it
  if (folder != nullptr && *folder == '/') return fs::path(folder) / kName;
  return fs::path(home != nullptr ? home : ".") / in_home / kName;
}

}  // namespace

fs::path user_cache_folder() { return user_folder("XDG_CACHE_HOME", ".cache"); }

fs::path user_state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }

}  // namespace gpo
