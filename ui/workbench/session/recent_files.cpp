// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/recent_files.h"

#include "engine/base/error.h"
#include "engine/files/json_text.h"
#include "engine/files/output_file.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/session/user_folders.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostRecent = 10;

void write_quietly(const fs::path& file, const std::string& text) {
  std::error_code none;
  fs::create_directories(file.parent_path(), none);
  try {
    write_file(file, text);
  } catch (const InputError&) {
    // Not worth a word: nobody asked for it.
  }
}

Json read_quietly(const fs::path& file) {
  try {
    return read_json(file);
  } catch (const InputError&) {
    return {};
  }
}

fs::path recent_list() { return user_state_folder() / "recent.json"; }

}  // namespace

fs::path last_session_file() { return user_state_folder() / "last-session.json"; }

void save_last_session(const WorkbenchState& state) {
  if (state.recording) write_quietly(last_session_file(), session_text(state));
}

std::vector<fs::path> recent_files() {
  std::vector<fs::path> files;
  std::error_code none;
  const Json json = read_quietly(recent_list());
  if (!json.is_array()) return files;
  for (const Json& one : json)
    if (one.is_string() && fs::exists(one.get<std::string>(), none))
      files.emplace_back(one.get<std::string>());
  return files;
}

void remember_file(const fs::path& path) {
  std::error_code none;
  const fs::path whole = fs::absolute(path, none);
  std::vector<fs::path> files = recent_files();
  std::erase(files, whole);
  files.insert(files.begin(), whole);
  files.resize(std::min(files.size(), kMostRecent));
  Json json = Json::array();
  for (const fs::path& one : files) json.push_back(one.string());
  write_quietly(recent_list(), json_text(json, 2));
}

}  // namespace gpo
