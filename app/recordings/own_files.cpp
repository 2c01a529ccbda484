// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/recordings/own_files.h"

#include "ui/workbench/session/recent_files.h"

#include <algorithm>
#include <system_error>

namespace gpo {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
  std::error_code none;
  return fs::read_symlink("/proc/self/exe", none).parent_path();
}

bool is_below(const fs::path& path, const fs::path& folder) {
  return std::ranges::mismatch(folder, path).in1 == folder.end();
}

}  // namespace

fs::path example_recording() {
  std::error_code none;
  const fs::path here = program_folder();
  fs::path example = fs::path("sequences") / "desk";
  for (const fs::path& root : {here.parent_path() / "share" / "gpo-inspector",
                               fs::path(GPO_SOURCE_DIR),
                               here,
                               here.parent_path(),
                               fs::current_path(none)}) {
    if (fs::exists(root / example, none)) return root / example;
  }
  return example;
}

fs::path made_recordings_folder() {
  fs::path built = GPO_RECORDINGS_DIR;
  if (is_below(program_folder(), built.parent_path())) return built;
  return user_cache_folder() / "recordings";
}

}  // namespace gpo
