// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The commands of findings: show the evidence, follow the advice, ignore it.
#include "engine/base/error.h"
#include "engine/diagnosis/diagnosis.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

/// Returns the findings with the key that the arguments begin with; there is at least one.
std::vector<Finding> findings_named(const State& state, const Arguments& arguments) {
  const auto& inspection = state.results.inspection;
  if (!inspection) throw InputError(arguments.action + ": no result yet");
  std::vector<Finding> named;
  std::vector<std::string> known;
  for (const Finding& finding : inspection->findings) {
    if (finding.key == arguments[0]) named.push_back(finding);
    if (std::ranges::count(known, finding.key) == 0) known.push_back(finding.key);
  }
  if (!named.empty()) return named;
  if (known.empty()) throw InputError(arguments.action + ": there are no findings");
  throw InputError(fmt::format("{}: no finding '{}', expected one of {}",
                               arguments.action,
                               arguments[0],
                               fmt::join(known, ", ")));
}

void show_pane(State& state, const std::string& key) {
  const Pane* pane = find_pane(key);
  if (pane == nullptr) return;
  if (pane->kind != PaneKind::image) return run_line(state, std::string("view ") + pane->key);
  state.view.panes.compare = false;
  if (state.view.division.maximized != WindowPart::image)
    state.view.division.maximized = WindowPart::none;
}

void show_finding(State& state, const Arguments& arguments) {
  const std::vector<Finding> findings = findings_named(state, arguments);
  const std::vector<std::int64_t> tracks = tracks_of(findings, *state.results.inspection->tracks);
  if (!tracks.empty()) state.selection = selected(tracks);
  const auto dated = std::ranges::find_if(
      findings, [](const Finding& finding) { return !finding.frames.empty(); });
  if (dated != findings.end()) {
    state.view.playing = false;
    go_to_frame(state, dated->frames.front());
  }
  show_pane(state, findings.front().view);
}

void run_finding(State& state, const Arguments& arguments) {
  const std::vector<Finding> findings = findings_named(state, arguments);
  const auto able = std::ranges::find_if(
      findings, [](const Finding& finding) { return !finding.command.empty(); });
  if (able == findings.end())
    throw InputError(fmt::format("{}: '{}' has no command", arguments.action, arguments[0]));
  run_line(state, able->command);
}

void ignore_finding(State& state, const Arguments& arguments) {
  Settings settings = state.document.settings;
  std::vector<std::string>& keys = settings.options.ignore_findings;
  const bool ignored = std::ranges::count(keys, arguments[0]) > 0;
  const bool ignore = arguments.on_off(ignored, 1);
  if (ignore == ignored) return;
  std::erase(keys, arguments[0]);
  if (ignore) keys.push_back(arguments[0]);
  check_ignored(keys);
  std::ranges::sort(keys);
  change_settings(state, std::move(settings));
}

}  // namespace

void add_finding_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Method", "Findings"};
  menu.add({"finding",
            "Show a finding",
            "Selects the tracks of a finding, goes to its first frame and opens the pane that "
            "shows it best"},
           "KEY",
           show_finding);
  menu.add({"run-finding", "Follow a finding's advice", "Runs the command that a finding offers"},
           "KEY",
           run_finding);
  menu.add({"ignore-finding",
            "Ignore a finding",
            "Judges the window without a finding, or with it again; Help, Findings lists which may "
            "be ignored"},
           "KEY [on|off]",
           ignore_finding);
}

}  // namespace gpo
