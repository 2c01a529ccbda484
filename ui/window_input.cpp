// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_input.h"

#include "ui/workbench/actions.h"

#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace gpo {
namespace {

WindowInput& input_of(GLFWwindow* window) {
  return *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
}

bool typing() { return ImGui::GetCurrentContext() != nullptr && ImGui::GetIO().WantTextInput; }

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

Commands WindowInput::take() { return std::exchange(commands_, {}); }

void WindowInput::on_key(GLFWwindow* window, int key, int, int action, int modifiers) {
  WindowInput& input = input_of(window);
  input.repeating_ = action == GLFW_REPEAT;
  const auto held = [modifiers](int modifier) { return (modifiers & modifier) != 0; };
  input.shortcut_ = held(GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  if (held(GLFW_MOD_ALT | GLFW_MOD_SUPER) || (typing() && key != GLFW_KEY_ESCAPE)) return;
  const Action* found = action_of_key(key, held(GLFW_MOD_SHIFT), held(GLFW_MOD_CONTROL));
  if (found == nullptr || (input.repeating_ && !found->repeats)) return;
  if (found->held) {
    push(input.commands_, RunAction{found->name + (action == GLFW_RELEASE ? " off" : " on")});
  } else if (action != GLFW_RELEASE) {
    push(input.commands_, RunAction{found->name});
  }
}

void WindowInput::on_character(GLFWwindow* window, unsigned codepoint) {
  WindowInput& input = input_of(window);
  if (input.shortcut_ || typing()) return;
  const Action* found = action_of_character(codepoint);
  if (found == nullptr || (input.repeating_ && !found->repeats)) return;
  push(input.commands_, RunAction{found->name});
}

void WindowInput::on_drop(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) push(input_of(window).commands_, OpenPath{paths[0]});
}

}  // namespace gpo
