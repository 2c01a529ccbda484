// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/session_file.h"

#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/text_file.h"
#include "engine/inspection/settings/settings_table.h"
#include "ui/workbench/session/session_fields.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
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
void change_span(Document& document, const Recording& to) {
  Settings& now = document.settings;
  const auto& from = document.recording->path;
  std::erase_if(document.spans, [&](const SavedSpan& one) { return one.recording == from; });
  document.spans.push_back({from, now.start, now.frames, now.options.method});
  const auto kept = std::ranges::find(document.spans, to.path, &SavedSpan::recording);
  const Settings standard;
  const bool known = kept != document.spans.end();
  now.start = known ? kept->start : standard.start;
  now.frames = known ? kept->frames : standard.frames;
  now.options.method = known ? kept->method : standard.options.method;
}

void reset_view(ViewState& view) {
  view.playing = false;
  view.play_seconds = 0;
  view.image_zoom = {};
  view.compare_zoom.reset();
  view.normals_zoom = {};
  view.orbit.reset();
}

/// Logs the notes of the recording and shows the first one.
void say_notes(WorkbenchState& state) {
  state.messages.text.clear();
  const auto& notes = state.document.recording->notes;
  for (const std::string& note : notes) say(state, note);
  if (!notes.empty()) state.messages.text = notes.front();
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

void continue_session(WorkbenchState& state, const SavedSession& session) {
  for (const SessionField& field : session_fields()) field.copy(*session.state, state);
  state.document.settings = fit_window(state.document.settings, state.frame_count());
  state.view.frame = std::clamp(state.view.frame, 0, std::max(0, state.frame_count() - 1));
}

bool is_session(const fs::path& file) {
  std::error_code none;
  if (file.extension() != ".json" || !fs::is_regular_file(file, none)) return false;
  return read_file(file).find(kKind) != std::string::npos;
}

void apply_recording(WorkbenchState& state, std::shared_ptr<const Recording> recording) {
  Document& document = state.document;
  const bool same =
      document.recording && recording->images && document.recording->images == recording->images;
  // The first recording gets the settings of the command line.
  if (document.recording && !same) change_span(document, *recording);
  document.recording = std::move(recording);
  document.cube_ray.reset();
  if (!same) document.bookmarks.clear();
  document.settings.exclude.clear();
  document.undo.clear();
  document.redo.clear();
  state.results.inspection.reset();
  state.results.surveyed = std::make_shared<const SurveyResults>();
  state.results.study.reset();
  state.results.scan.reset();
  state.selection = {};
  state.hover = {};
  reset_view(state.view);
  say_notes(state);
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
  state.view.time_span = first_time_span(fitting, frames);
  if (!same) state.view.frame = std::max(0, fitting.start + std::min(fitting.frames, frames) - 1);
  if (const auto session = std::exchange(state.files.waiting_session, {}))
    continue_session(state, *session);
}

}  // namespace gpo
