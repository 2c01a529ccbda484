// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_input.h"

#include "ui/workbench/actions/actions.h"

#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace gpo {
namespace {

WindowInput& input_of(GLFWwindow* window) {
  return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}

}  // namespace

WindowInput::WindowInput(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, this);
  glfwSetKeyCallback(window, on_key);
  glfwSetCharCallback(window, on_character);
  glfwSetDropCallback(window, on_drop);
}

WindowInput::~WindowInput() {
  glfwSetKeyCallback(window_, nullptr);
  glfwSetCharCallback(window_, nullptr);
  glfwSetDropCallback(window_, nullptr);
  glfwSetWindowUserPointer(window_, nullptr);
}

bool WindowInput::typing() {
  const bool wanted = ImGui::GetCurrentContext() != nullptr && ImGui::GetIO().WantTextInput;
  if (wanted) will_type_ = false;
  return wanted || will_type_;
}

void WindowInput::run(const std::string& line) {
  // Its field wants text from the next frame on; what is typed before then is no shortcut.
  if (line == "palette") will_type_ = true;
  push(commands_, RunAction{line});
}

Commands WindowInput::take() { return std::exchange(commands_, {}); }

void WindowInput::on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
  WindowInput& input = input_of(window);
  input.repeating_ = action == GLFW_REPEAT;
  const auto held = [modifiers](int modifier) { return (modifiers & modifier) != 0; };
  if (key == GLFW_KEY_ESCAPE) input.will_type_ = false;
  input.shortcut_ = held(GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  if (held(GLFW_MOD_ALT | GLFW_MOD_SUPER) || (input.typing() && key != GLFW_KEY_ESCAPE)) return;
  const Action* found = action_of_key(key, held(GLFW_MOD_SHIFT), held(GLFW_MOD_CONTROL));
  if (found == nullptr || (input.repeating_ && !found->repeats)) return;
  if (found->held) {
    input.run(found->name + (action == GLFW_RELEASE ? " off" : " on"));
  } else if (action != GLFW_RELEASE) {
    input.run(found->name);
  }
}

void WindowInput::on_character(GLFWwindow* window, unsigned codepoint) {
  WindowInput& input = input_of(window);
  if (input.shortcut_ || input.typing()) return;
  const Action* found = action_of_character(codepoint);
  if (found == nullptr || (input.repeating_ && !found->repeats)) return;
  input.run(found->name);
}

void WindowInput::on_drop(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) push(input_of(window).commands_, OpenPath{paths[0]});
}

}  // namespace gpo
