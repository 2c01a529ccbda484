// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_input.h"

#include "ui/context/imgui_versions.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/state.h"

#include <utility>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

namespace gpo {
namespace {

using Kind = InputEvent::Kind;

/// One that never comes (nothing has the keyboard) must not stop the keys for ever.
constexpr int kMostFramesWithoutField = 10;

InputQueue& queue_of(GLFWwindow* window) {
  return *static_cast<InputQueue*>(glfwGetWindowUserPointer(window));
}

void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
  queue_of(window).push({Kind::key, key, scancode, action, modifiers});
}
void on_character(GLFWwindow* window, unsigned codepoint) {
  queue_of(window).push({.kind = Kind::character, .character = codepoint});
}
void on_button(GLFWwindow* window, int button, int action, int modifiers) {
  queue_of(window).push({Kind::button, button, 0, action, modifiers});
}
void on_scroll(GLFWwindow* window, double x, double y) {
  queue_of(window).push({.kind = Kind::scroll, .x = x, .y = y});
}
/// Pixels are what is drawn in; on Wayland the pointer is told in larger units.
void on_pointer(GLFWwindow* window, double x, double y) {
  int width = 0, height = 0, width_px = 0, height_px = 0;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &width_px, &height_px);
  if (width > 0) x *= static_cast<double>(width_px) / width;
  if (height > 0) y *= static_cast<double>(height_px) / height;
  queue_of(window).push({.kind = Kind::pointer, .x = x, .y = y});
}
void on_enter(GLFWwindow* window, int entered) {
  queue_of(window).push({.kind = Kind::enter, .code = entered});
}
void on_focus(GLFWwindow* window, int focused) {
  queue_of(window).push({.kind = Kind::focus, .code = focused});
}
void on_drop(GLFWwindow* window, int count, const char** paths) {
  if (count > 0) queue_of(window).push({.kind = Kind::drop, .path = paths[0]});
}

void hand_to_imgui(GLFWwindow* window, const InputEvent& event) {
  switch (event.kind) {
    case Kind::key:
      return hand_key_to_imgui(window, event.code, event.scancode, event.action, event.modifiers);
    case Kind::character:
      return ImGui_ImplGlfw_CharCallback(window, event.character);
    case Kind::button:
      return ImGui_ImplGlfw_MouseButtonCallback(window, event.code, event.action, event.modifiers);
    case Kind::scroll:
      return ImGui_ImplGlfw_ScrollCallback(window, event.x, event.y);
    case Kind::pointer:
      return hand_pointer_to_imgui(window, event.x, event.y);
    case Kind::enter:
      return ImGui_ImplGlfw_CursorEnterCallback(window, event.code);
    case Kind::focus:
      return ImGui_ImplGlfw_WindowFocusCallback(window, event.code);
    case Kind::drop:
      return;
  }
}

/// What is open has one that takes all keys.
bool has_field(const WorkbenchState& state) { return state.view.palette || state.view.browse; }

bool popup_is_open() {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

}  // namespace

WindowInput::WindowInput(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, &queue_);
  glfwSetKeyCallback(window, on_key);
  glfwSetCharCallback(window, on_character);
  glfwSetMouseButtonCallback(window, on_button);
  glfwSetScrollCallback(window, on_scroll);
  glfwSetCursorPosCallback(window, on_pointer);
  glfwSetCursorEnterCallback(window, on_enter);
  glfwSetWindowFocusCallback(window, on_focus);
  glfwSetDropCallback(window, on_drop);
}

WindowInput::~WindowInput() {
  glfwSetKeyCallback(window_, nullptr);
  glfwSetCharCallback(window_, nullptr);
  glfwSetMouseButtonCallback(window_, nullptr);
  glfwSetScrollCallback(window_, nullptr);
  glfwSetCursorPosCallback(window_, nullptr);
  glfwSetCursorEnterCallback(window_, nullptr);
  glfwSetWindowFocusCallback(window_, nullptr);
  glfwSetDropCallback(window_, nullptr);
  glfwSetWindowUserPointer(window_, nullptr);
}

Listener WindowInput::listener(const WorkbenchState& state) {
  if (ImGui::GetIO().WantTextInput) return Listener::field;
  if (has_field(state) && frames_without_field_ < kMostFramesWithoutField) return Listener::nobody;
  return popup_is_open() ? Listener::popup : Listener::shortcuts;
}

Commands WindowInput::dispatch(const WorkbenchState& state) {
  Commands commands;
  queue_.begin_frame();
  const bool waits = has_field(state) && !ImGui::GetIO().WantTextInput;
  frames_without_field_ = waits ? frames_without_field_ + 1 : 0;
  while (queue_.has_next(listener(state))) {
    const InputEvent event = queue_.take();
    hand_to_imgui(window_, event);
    handle_event(event, state, commands);
  }
  return commands;
}

void WindowInput::handle_event(const InputEvent& event, const WorkbenchState& state, Commands& commands) {
  if (event.kind == Kind::drop) push(commands, OpenPath{event.path});
  if (event.kind == Kind::key) heed_key(event, state, commands);
  if (event.kind == Kind::character) heed_character(event, state, commands);
}

void WindowInput::heed_key(const InputEvent& event,
                           const WorkbenchState& state,
                           Commands& commands) {
  const auto held = [&](int modifier) { return (event.modifiers & modifier) != 0; };
  repeating_ = event.action == GLFW_REPEAT;
  shortcut_ = held(GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  const bool escape = event.code == GLFW_KEY_ESCAPE;
  // Esc shuts a menu before it does anything else, and in a field it takes back what was typed.
  if (escape && event.action != GLFW_RELEASE && popup_is_open()) return close_popups();
  const bool typed = ImGui::GetIO().WantTextInput && !(escape && has_field(state));
  const bool of_popup = popup_is_open() && types(event);
  if (held(GLFW_MOD_ALT | GLFW_MOD_SUPER) || typed || of_popup) return;
  const Action* found = action_of_key(event.code, held(GLFW_MOD_SHIFT), held(GLFW_MOD_CONTROL));
  if (found == nullptr || (repeating_ && !found->repeats)) return;
  if (found->held) {
    push(commands, RunAction{found->name + (event.action == GLFW_RELEASE ? " off" : " on")});
  } else if (event.action != GLFW_RELEASE) {
    push(commands, RunAction{found->name});
    if (found->opens_field) queue_.end_frame();
  }
}

void WindowInput::heed_character(const InputEvent& event,
                                 const WorkbenchState& state,
                                 Commands& commands) {
  if (shortcut_ || listener(state) != Listener::shortcuts) return;
  const Action* found = action_of_character(event.character);
  if (found == nullptr || (repeating_ && !found->repeats)) return;
  push(commands, RunAction{found->name});
  if (found->opens_field) queue_.end_frame();
}

}  // namespace gpo
