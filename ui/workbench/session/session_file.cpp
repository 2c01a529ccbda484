// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/session/session_file.h"

#include "engine/base/error.h"
#include "engine/external_methods/own_method.h"
#include "engine/files/json_text.h"
#include "engine/files/text_file.h"
#include "engine/inspection/settings/setting_values.h"
#include "ui/workbench/session/session_fields.h"
#include "ui/workbench/time_span.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using Json = SessionJson;

constexpr int kVersion = 1;
constexpr const char* kKind = "gpo-inspector session";

/// The user's own methods, for whoever opens the session to start them or not.
void write_own_methods(const MethodTable& methods, Json& json) {
  const MethodSpecs own = specs_in(methods);
  if (!own.commands.empty()) json["method_commands"] = own.commands;
  std::vector<std::string> results;
  for (const std::string& one : own.results) results.push_back(with_whole_paths(one));
  if (!results.empty()) json["results"] = results;
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
  if (json.is_discarded()) throw InputError(file.string() + ": not valid JSON; expected a session");
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

}  // namespace gpo
