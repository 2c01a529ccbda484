// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/recent_files.h"

#include "engine/base/error.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "ui/workbench/session/session_fields.h"
#include "ui/workbench/session/session_file.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

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
    // The user did not request this file, so its failure is not worth a message.
  }
}

Json read_quietly(const fs::path& file) {
  try {
    return read_json(file);
  } catch (const InputError&) {
    return {};
  }
}

/// Session fields that are stored with the window.
constexpr std::array kWindowFields = {"theme", "division", "text_zoom"};

bool is_window_field(const SessionField& field) {
  return std::ranges::count(kWindowFields, std::string_view(field.key)) > 0;
}

fs::path window_file() { return user_state_folder() / "window.json"; }
fs::path recent_list() { return user_state_folder() / "recent.json"; }

fs::path user_folder(const char* variable, const fs::path& in_home) {
  constexpr const char* kName = "gpo-inspector";
  const char* folder = std::getenv(variable);  // NOLINT(concurrency-mt-unsafe): never set here
  const char* home = std::getenv("HOME");      // NOLINT(concurrency-mt-unsafe): never set here
  if (folder != nullptr && *folder == '/') return fs::path(folder) / kName;
  return fs::path(home != nullptr ? home : ".") / in_home / kName;
}

}  // namespace

fs::path user_cache_folder() { return user_folder("XDG_CACHE_HOME", ".cache"); }

fs::path user_state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }

fs::path last_session_file() { return user_state_folder() / "last-session.json"; }

void save_last_session(const WorkbenchState& state) {
  if (state.document.recording) write_quietly(last_session_file(), session_text(state));
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

SavedWindow read_saved_window(WorkbenchState& state) {
  const Json json = read_quietly(window_file());
  SavedWindow kept;
  if (!json.is_object()) return kept;
  try {
    constexpr int kMost = 100'000;
    const SessionReader read(json, window_file().string());
    read("width", kept.width, 0, kMost);
    read("height", kept.height, 0, kMost);
    for (const SessionField& field : session_fields())
      if (is_window_field(field) && read.has(field.key)) field.read(read, state);
  } catch (const InputError&) {
    // Edited by hand and invalid: the window opens with its defaults.
  }
  return kept;
}

void save_window(const SavedWindow& window, const WorkbenchState& state) {
  Json json = {{"width", window.width}, {"height", window.height}};
  for (const SessionField& field : session_fields())
    if (is_window_field(field)) json[field.key] = field.write(state);
  write_quietly(window_file(), json_text(json, 2));
}

}  // namespace gpo
