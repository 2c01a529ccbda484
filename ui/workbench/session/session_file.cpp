// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/session_file.h"

#include "engine/external_methods/own_method.h"
#include "engine/files/output_file.h"
#include "engine/files/text_file.h"
#include "ui/workbench/session/session_fields.h"

#include <cstdlib>
#include <string_view>

namespace gpo {
namespace {

using Json = SessionJson;

constexpr int kVersion = 1;
constexpr const char* kKind = "gpo-inspector session";

void write_own_methods(const MethodTable& methods, Json& json) {
  const MethodSpecs own = specs_in(methods);
  if (!own.commands.empty()) json["method_commands"] = own.commands;
  std::vector<std::string> results;
  for (const std::string& one : own.results) results.push_back(with_whole_paths(one));
  if (!results.empty()) json["results"] = results;
}

/// Restores window and method last used with the recording `to`, else their defaults.
void change_window(Document& document, const Recording& to) {
  Settings& now = document.settings;
  document.earlier[document.recording->path] = now;
  const Settings& last = document.earlier[to.path];
  now.start = last.start;
  now.frames = last.frames;
  now.options.method = last.options.method;
}

void reset_view(ViewState& view) {
  view.playing = false;
  view.play_seconds = 0;
  view.image_zoom = {};
  view.compare_zoom.reset();
  view.normals_zoom = {};
  view.orbit.reset();
  view.drawn_mask.reset();
}

void reset_results(ComputedResults& results) {
  results.inspection.reset();
  results.surveyed = std::make_shared<const SurveyResults>();
  results.study.reset();
  results.scan.reset();
}

/// Resets what the user did with the tracks and cubes of a recording.
void reset_edits(WorkbenchState& state) {
  Document& document = state.document;
  document.cube_ray.reset();
  document.other_cube_rays.clear();
  document.settings.exclude.clear();
  document.undo.clear();
  document.redo.clear();
  state.selection = {};
  state.hover = {};
}

/// Puts the recording's notes into the log, and the first one into the message line.
void say_notes(WorkbenchState& state) {
  state.messages.text.clear();
  const auto& notes = state.document.recording->notes;
  for (const std::string& note : notes) say(state, note);
  if (!notes.empty()) state.messages.text = notes.front();
}

/// Returns whether a recording is open that can be opened again; that of a live source cannot.
bool has_file(const WorkbenchState& state) {
  return state.document.recording && state.document.recording->layout != kLiveLayout;
}

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

/// Returns the absolute path without "." and a slash at its end.
fs::path plain_path(const fs::path& path) {
  std::error_code none;
  const fs::path plain = fs::absolute(path, none).lexically_normal();
  return plain.has_filename() ? plain : plain.parent_path();
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

std::string session_text(const WorkbenchState& state) {
  Json json = {{"kind", kKind}, {"version", kVersion}};
  json["recording"] = state.document.recording
                          ? Json(fs::absolute(state.document.recording->path).string())
                          : Json();
  write_own_methods(state.methods, json);
  for (const SessionField& field : session_fields()) json[field.key] = field.write(state);
  return json_text(json, 2);
}

SavedSession read_session(const fs::path& file, const MethodTable& methods) {
  const Json json = read_json(file);
  if (json.is_discarded()) throw InputError(file.string() + ": not valid JSON, expected a session");
  const SessionReader read(json, file.string());
  std::string kind, recording;
  int version = 0;
  read("kind", kind);
  read("version", version, 0, 1'000'000);
  read("recording", recording);
  if (kind != kKind)
    throw InputError(fmt::format("{}: kind: '{}', expected '{}'", file.string(), kind, kKind));
  if (version != kVersion)
    throw InputError(fmt::format("{}: version: {}, expected {}", file.string(), version, kVersion));
  SavedSession session;
  auto state = std::make_shared<WorkbenchState>();
  state->methods = methods;
  for (const SessionField& field : session_fields())
    if (read.has(field.key)) field.read(read, *state);
  session.state = state;
  session.recording = recording;
  std::error_code none;
  const fs::path beside = file.parent_path() / session.recording.filename();
  if (!recording.empty() && !fs::exists(session.recording, none) && fs::exists(beside, none))
    session.recording = beside;
  return session;
}

bool is_session(const fs::path& file) {
  std::error_code none;
  if (file.extension() != ".json" || !fs::is_regular_file(file, none)) return false;
  if (fs::file_size(file, none) > limits().json_bytes) return false;  // see `read_session`
  return read_file(file).find(kKind) != std::string::npos;
}

void apply_recording(WorkbenchState& state, std::shared_ptr<const Recording> recording) {
  Document& document = state.document;
  const bool same =
      document.recording && recording->images && document.recording->images == recording->images;
  // The frames so far, when its list of frames was still being read, were shown already.
  const bool continued = document.recording && !document.recording->complete &&
                         document.recording->path == recording->path &&
                         !state.files.waiting_session;
  const bool stays = same || continued;
  // The first recording gets the settings of the command line.
  if (document.recording && !stays) {
    for (const Setting& setting : settings_table())
      if (setting.by_hand) setting.set(document.settings, setting.get(Settings{}));
    change_window(document, *recording);
  }
  const int frames_before = state.frame_count();
  document.recording = std::move(recording);
  if (!stays) document.bookmarks.clear();
  reset_results(state.results);
  if (!continued) {
    reset_edits(state);
    reset_view(state.view);
    say_notes(state);
  }
  const int frames = state.frame_count();
  const Settings fitting = fit_window(document.settings, frames);
  if (fitting.start != document.settings.start)
    say(state,
        fmt::format("Start frame {} is outside of the recording: the last of {} frames is {}",
                    document.settings.start,
                    frames,
                    frames - 1),
        Severity::warning);
  document.settings = fitting;
  // The user may have zoomed the time line of the frames so far.
  if (!continued || state.view.time_span == first_time_span(fitting, frames_before))
    state.view.time_span = first_time_span(fitting, frames);
  if (!stays) state.view.frame = std::max(0, fitting.start + std::min(fitting.frames, frames) - 1);
  const auto session = std::exchange(state.files.waiting_session, {});
  if (!session) return;
  for (const SessionField& field : session_fields()) field.copy(*session->state, state);
  document.settings = fit_window(document.settings, frames);
  state.view.frame = std::clamp(state.view.frame, 0, std::max(0, frames - 1));
}

fs::path user_cache_folder() { return user_folder("XDG_CACHE_HOME", ".cache"); }

fs::path user_state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }

fs::path last_session_file() { return user_state_folder() / "last-session.json"; }

void save_last_session(const WorkbenchState& state) {
  if (has_file(state)) write_quietly(last_session_file(), session_text(state));
}

void SessionSaver::note_change() {
  constexpr double kPause_s = 2;
  if (!left_s_) left_s_ = kPause_s;
}

void SessionSaver::advance(const WorkbenchState& state, double seconds) {
  if (!left_s_) return;
  *left_s_ -= seconds;
  if (*left_s_ > 0) return;
  left_s_.reset();
  if (!has_file(state)) return;
  std::string text = session_text(state);
  if (text == saved_) return;
  write_quietly(last_session_file(), text);
  saved_ = std::move(text);
}

std::vector<fs::path> recent_files() {
  std::vector<fs::path> files;
  std::error_code none;
  const Json json = read_quietly(recent_list());
  if (!json.is_array()) return files;
  for (const Json& one : json) {
    if (!one.is_string()) continue;
    const fs::path file = plain_path(one.get<std::string>());
    if (fs::exists(file, none) && std::ranges::count(files, file) == 0) files.push_back(file);
  }
  return files;
}

void remember_file(const fs::path& path) {
  const fs::path whole = plain_path(path);
  std::vector<fs::path> files = recent_files();
  std::erase(files, whole);
  files.insert(files.begin(), whole);
  files.resize(std::min(files.size(), kMostRecent));
  Json json = Json::array();
  for (const fs::path& one : files) json.push_back(one.string());
  write_quietly(recent_list(), json_text(json, 2));
}

cv::Size read_saved_window(WorkbenchState& state) {
  const Json json = read_quietly(window_file());
  cv::Size kept;
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

void save_window(cv::Size window, const WorkbenchState& state) {
  Json json = {{"width", window.width}, {"height", window.height}};
  for (const SessionField& field : session_fields())
    if (is_window_field(field)) json[field.key] = field.write(state);
  write_quietly(window_file(), json_text(json, 2));
}

}  // namespace gpo
