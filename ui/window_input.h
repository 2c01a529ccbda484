// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/input_queue.h"
#include "ui/workbench/commands.h"

struct GLFWwindow;

namespace gpo {

struct WorkbenchState;

/// Keys, mouse and dropped files of a window, on their way to Dear ImGui and as commands. `Gui`
/// takes nothing from the window by itself.
class WindowInput {
 public:
  explicit WindowInput(GLFWwindow* window);
  ~WindowInput();
  WindowInput(const WindowInput&) = delete;
  WindowInput& operator=(const WindowInput&) = delete;

  /// Before each frame: hands on to Dear ImGui what belongs to it. Returns what of it are commands.
  /// The rest waits for the next frame.
  Commands dispatch(const WorkbenchState& state);
  /// Whether something waits for the next frame.
  bool waiting() const { return !queue_.empty(); }

 private:
  Listener listener(const WorkbenchState& state);
  void handle_event(const InputEvent& event, const WorkbenchState& state, Commands& commands);
  void heed_key(const InputEvent& event, const WorkbenchState& state, Commands& commands);
  void heed_character(const InputEvent& event, const WorkbenchState& state, Commands& commands);

  GLFWwindow* window_;
  InputQueue queue_;
  int frames_without_field_ = 0;  ///< since the palette is open
  bool repeating_ = false;        ///< the key that types the next character is being held
  bool shortcut_ = false;         ///< ... together with Ctrl, Alt or Super
};

}  // namespace gpo
