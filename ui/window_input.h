// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/commands.h"

#include <string>

struct GLFWwindow;

namespace gpo {

/// Keys and dropped files of a window as commands. To be made before `Gui`, which passes events on
/// to it. Needs Dear ImGui to be there when events come: keys that type into a field are left out.
class WindowInput {
 public:
  explicit WindowInput(GLFWwindow* window);
  ~WindowInput();
  WindowInput(const WindowInput&) = delete;
  WindowInput& operator=(const WindowInput&) = delete;

  /// What came since the last call.
  Commands take();

 private:
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
  static void on_character(GLFWwindow* window, unsigned codepoint);
  static void on_drop(GLFWwindow* window, int count, const char** paths);

  /// Whether keys are text for a field.
  bool typing();
  void run(const std::string& line);

  GLFWwindow* window_;
  Commands commands_;
  bool repeating_ = false;  ///< the key that types the next character is being held
  bool will_type_ = false;  ///< a field was opened and has not been drawn yet
  bool shortcut_ = false;   ///< ... together with Ctrl, Alt or Super
};

}  // namespace gpo
