// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/error.h"
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <sstream>

namespace gpo::test {

inline std::shared_ptr<const Inspection> shared_inspection(const MadeOptions& options = {}) {
  return std::make_shared<const Inspection>(made_inspection(options));
}

inline void open(WorkbenchState& state, const std::shared_ptr<const Inspection>& inspection) {
  state.document.settings = inspection->settings;
  apply_recording(state, inspection->recording);
  state.results.inspection = inspection;
}

/// Runs the lines of a script, with semicolons in between.
inline void run_lines(WorkbenchState& state, const std::string& script) {
  std::istringstream lines(script);
  for (std::string line; std::getline(lines, line, ';');) run_line(state, line);
}

/// Returns the error of a line of a script; empty if it runs.
inline std::string refusal(WorkbenchState& state, const std::string& line) {
  try {
    run_line(state, line);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Returns the first command of a type; null if there is none.
template <class C>
const C* find(const Commands& commands) {
  for (const Command& command : commands)
    if (const C* found = command.target<C>()) return found;
  return nullptr;
}

/// Returns the first command of a type; throws if there is none.
template <class C>
C first(const Commands& commands) {
  const C* found = find<C>(commands);
  return found != nullptr ? *found : throw std::out_of_range("no such command");
}

/// Returns the line of the first action; empty if there is none.
inline std::string line_of(const Commands& commands) {
  const auto* action = find<RunAction>(commands);
  return action == nullptr ? "" : action->line;
}

class WindowTest : public DrawingTest {
 protected:
  static constexpr int kWidth = 1280, kHeight = 720;

  PanelInput input() const {
    return {.state = state_, .worker = worker_, .timings = timings_, .fetcher = fetching_};
  }
  Commands draw(cv::Size size = {kWidth, kHeight}) {
    context_.bind();
    Commands commands = draw_workbench(input(), size, gui_, *views_);
    for (const Command& command : commands)
      if (applies_) apply(state_, command);
    return commands;
  }
  void draw_times(int frames) {
    for (int i = 0; i < frames; ++i) draw();
  }
  Commands wheel(float x, float y, float turns = 1) {
    point_at(x, y);
    ImGui::GetIO().MouseWheel = turns;
    return draw();
  }
  cv::Mat view(const std::string& name, std::optional<cv::Size> size = {}) {
    return draw_view(name, size, input(), {}, {gui_, *views_});
  }
  void open(const Inspection& inspection) {
    inspection_ = std::make_shared<const Inspection>(inspection);
    test::open(state_, inspection_);
    draw();
  }
  /// Dear ImGui finds out in one frame what the mouse hovers, and acts on it in the next.
  Commands point_at(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    draw();
    return draw();
  }
  Commands press(bool down, int button = 0) {
    ImGui::GetIO().MouseDown[button] = down;
    return draw();
  }
  Commands click(float x, float y, int button = 0) {
    point_at(x, y);
    Commands all = press(true, button);
    for (const Command& command : press(false, button)) push(all, command);
    return all;
  }
  WindowLayout layout() const {
    return window_layout({.width = kWidth,
                          .height = kHeight,
                          .drawer_open = state_.view.panes.drawer != nullptr,
                          .beside_open = state_.view.panes.beside != nullptr,
                          .failed = has_failed(input()),
                          .verdict_height = views_ ? views_->verdict_height : 0,
                          .settings_height = views_ ? views_->settings_height : 0});
  }

  OffscreenContext context_{kWidth, kHeight};
  Gui gui_;
  std::unique_ptr<Views> views_ = std::make_unique<Views>();
  WorkbenchState state_;
  JobStatus worker_;
  bool timings_ = true;
  bool applies_ = false;                  ///< commands change the state
  ImageFetcher* fetching_ = nullptr;      ///< null: drawing decodes images itself
  const WindowLayout layout_ = layout();  ///< with the drawer closed, before the first frame
  std::shared_ptr<const Inspection> inspection_;
};

}  // namespace gpo::test
