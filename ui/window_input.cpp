// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/window_input.h"

#include "ui/context/imgui_versions.h"

#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

using Kind = InputEvent::Kind;

/// Dear ImGui reports two frames late whether a field wants text.
constexpr int kFramesToFocus = 3;
/// After that many frames keys no longer wait for a text field that does not open.
constexpr int kMostFramesWithoutField = 10;

/// Returns whether the key may open, close or leave a text field.
bool changes_focus(int key) {
  return key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER || key == GLFW_KEY_TAB ||
         key == GLFW_KEY_ESCAPE;
}

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }

/// Returns whether it presses a key that types nothing: Ctrl, an arrow, Backspace, Ctrl+letter.
bool is_command(const InputEvent& event) {
  return event.kind == Kind::key && event.action != GLFW_RELEASE && !types(event) &&
         event.code != GLFW_KEY_LEFT_SHIFT && event.code != GLFW_KEY_RIGHT_SHIFT;
}

/// Drops the event if there is no `WindowInput` any more.
void queue_event(GLFWwindow* window, InputEvent event) {
  auto* queue = static_cast<InputQueue*>(glfwGetWindowUserPointer(window));
  event.time_s = glfwGetTime();
  if (queue != nullptr) queue->push(std::move(event));
}

/// Scales to pixels; on Wayland screen units are larger.
void on_pointer(GLFWwindow* window, double x, double y) {
  int width = 0, height = 0, width_px = 0, height_px = 0;
  glfwGetWindowSize(window, &width, &height);
  glfwGetFramebufferSize(window, &width_px, &height_px);
  if (width > 0) x *= static_cast<double>(width_px) / width;
  if (height > 0) y *= static_cast<double>(height_px) / height;
  queue_event(window, {.kind = Kind::pointer, .x = x, .y = y});
}

/// Returns whether an open overlay has a text field that takes all keys.
bool has_field(const WorkbenchState& state) {
  return state.view.palette || state.view.browse || state.view.sources;
}

bool popup_is_open() {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

bool is_letter_or_digit(int key) {
  return (key >= GLFW_KEY_A && key <= GLFW_KEY_Z) || (key >= GLFW_KEY_0 && key <= GLFW_KEY_9);
}

/// Returns the action of a key by the layout; without one, that of a digit by its place: a French
/// layout has other characters there.
const Action* action_of_press(const InputEvent& event) {
  const bool shift = (event.modifiers & GLFW_MOD_SHIFT) != 0;
  const bool control = (event.modifiers & GLFW_MOD_CONTROL) != 0;
  const Action* found = action_of_key(event.layout_key, shift, control);
  const bool digit = event.code >= GLFW_KEY_0 && event.code <= GLFW_KEY_9;
  return found == nullptr && digit ? action_of_key(event.code, shift, control) : found;
}

/// Returns the character whose action a key runs: the typed one or, if that has no action, what a
/// US keyboard has at the place of a digit, and of a letter that is not Latin.
char32_t character_for_shortcut(char32_t typed, int place, const WorkbenchState& state) {
  const bool digit = place >= GLFW_KEY_0 && place <= GLFW_KEY_9;
  const bool foreign = typed > 0x7F && is_letter_or_digit(place);
  if (action_of_character(typed, &state) != nullptr || !(digit || foreign)) return typed;
  return static_cast<char32_t>(place);
}

}  // namespace

int key_in_layout(int place, std::string_view name) {
  if (place < GLFW_KEY_SPACE || place > GLFW_KEY_WORLD_2 || name.empty()) return place;
  const auto first = static_cast<unsigned char>(name.front());
  if (name.size() == 1 && first < 0x80)
    return first >= 'a' && first <= 'z' ? first - 'a' + GLFW_KEY_A : first;
  return is_letter_or_digit(place) ? place : GLFW_KEY_UNKNOWN;
}

bool types(const InputEvent& event) {
  constexpr int kCommands = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  return event.kind == Kind::key && event.code >= GLFW_KEY_SPACE &&
         event.code <= GLFW_KEY_WORLD_2 && (event.modifiers & kCommands) == 0;
}

void InputQueue::push(InputEvent event) {
  // Only the last pointer position matters.
  if (event.kind == Kind::pointer && !events_.empty() && events_.back().kind == Kind::pointer)
    events_.pop_back();
  events_.push_back(std::move(event));
}

void InputQueue::begin_frame() {
  changed_.clear();
  frame_ = Frame::empty;
  if (keys_wait_ > 0) --keys_wait_;
}

bool InputQueue::has_next(Listener listener) const {
  if (events_.empty() || frame_ == Frame::ended) return false;
  const InputEvent& next = events_.front();
  const bool of_keyboard = next.kind == Kind::key || next.kind == Kind::character;
  if (of_keyboard && (listener == Listener::none || keys_wait_ > 0)) return false;
  if (next.kind == Kind::character) return frame_ == Frame::empty || frame_ == Frame::characters;
  if (has_characters() && is_command(next) && is_modifier(next.code)) return false;
  if (next.kind != Kind::key || listener == Listener::shortcuts || types(next)) return true;
  return !changed_.contains(next.code);
}

InputEvent InputQueue::take() {
  InputEvent event = std::move(events_.front());
  events_.pop_front();
  if (event.kind == Kind::key) changed_.insert(event.code);
  if (event.kind == Kind::character) frame_ = Frame::characters;
  if (is_command(event))
    frame_ = has_characters() ? Frame::characters_and_commands : Frame::commands;
  const bool entered =
      event.kind == Kind::key && event.action != GLFW_RELEASE && changes_focus(event.code);
  if (event.kind == Kind::button || entered) {
    frame_ = Frame::ended;
    keys_wait_ = kFramesToFocus;
  }
  return event;
}

WindowInput::WindowInput(GLFWwindow* window) : window_(window) {
  glfwSetWindowUserPointer(window, &queue_);
  glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int modifiers) {
    const char* name = glfwGetKeyName(key, scancode);
    queue_event(w,
                {.kind = Kind::key,
                 .code = key,
                 .scancode = scancode,
                 .action = action,
                 .modifiers = modifiers,
                 .layout_key = key_in_layout(key, name != nullptr ? name : "")});
  });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned codepoint) {
    queue_event(w, {.kind = Kind::character, .character = codepoint});
  });
  glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int modifiers) {
    queue_event(w, {Kind::button, button, 0, action, modifiers});
  });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
    queue_event(w, {.kind = Kind::scroll, .x = x, .y = y});
  });
  glfwSetCursorPosCallback(window, on_pointer);
  glfwSetCursorEnterCallback(window, [](GLFWwindow* w, int entered) {
    queue_event(w, {.kind = Kind::enter, .code = entered});
  });
  glfwSetWindowFocusCallback(window, [](GLFWwindow* w, int focused) {
    queue_event(w, {.kind = Kind::focus, .code = focused});
  });
  glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
    if (count > 0) queue_event(w, {.kind = Kind::drop, .code = count, .path = paths[0]});
  });
}

void push_drop(const InputEvent& event, Commands& commands) {
  push(commands, OpenPath{event.path});
  if (event.code > 1)
    push(commands, [count = event.code, path = event.path](WorkbenchState& state) {
      say(state,
          fmt::format("{} files were dropped: only {} is opened", count, path),
          Severity::warning);
    });
}

WindowInput::~WindowInput() { glfwSetWindowUserPointer(window_, nullptr); }

Listener WindowInput::listener(const WorkbenchState& state) {
  if (ImGui::GetIO().WantTextInput) return Listener::field;
  if (has_field(state) && frames_without_field_ < kMostFramesWithoutField) return Listener::none;
  return popup_is_open() ? Listener::popup : Listener::shortcuts;
}

Commands WindowInput::dispatch(const WorkbenchState& state) {
  Commands commands;
  queue_.begin_frame();
  const bool waits = has_field(state) && !ImGui::GetIO().WantTextInput;
  frames_without_field_ = waits ? frames_without_field_ + 1 : 0;
  while (queue_.has_next(listener(state))) {
    const InputEvent event = queue_.take();
    const Listener before = listener(state);
    if (before == Listener::field) keys_.note_field(event);
    hand_to_imgui(event);
    if (event.kind == Kind::drop) push_drop(event, commands);
    const bool opens_field =
        (event.kind == Kind::key && keys_.press(event, before, state, commands)) ||
        (event.kind == Kind::character && keys_.type(event, before, state, commands));
    if (opens_field) queue_.end_frame();
  }
  return commands;
}

void WindowInput::hand_to_imgui(const InputEvent& event) {
  switch (event.kind) {
    case Kind::key: {
      // A key is released as it was pressed, even if the layout has changed.
      int& key = imgui_keys_.try_emplace(event.code, event.code).first->second;
      if (event.action != GLFW_RELEASE) key = key_for_imgui(event.code, event.layout_key);
      return hand_key_to_imgui(window_, key, event.scancode, event.action, event.modifiers);
    }
    case Kind::character:
      return ImGui_ImplGlfw_CharCallback(window_, event.character);
    case Kind::button:
      return ImGui_ImplGlfw_MouseButtonCallback(window_, event.code, event.action, event.modifiers);
    case Kind::scroll:
      return ImGui_ImplGlfw_ScrollCallback(window_, event.x, event.y);
    case Kind::pointer:
      return hand_pointer_to_imgui(window_, event.x, event.y);
    case Kind::enter:
      return ImGui_ImplGlfw_CursorEnterCallback(window_, event.code);
    case Kind::focus:
      return ImGui_ImplGlfw_WindowFocusCallback(window_, event.code);
    case Kind::drop:
      return;
  }
}

bool KeyCommands::press(const InputEvent& event,
                        Listener listener,
                        const WorkbenchState& state,
                        Commands& commands) {
  const auto with = [&](int modifier) { return (event.modifiers & modifier) != 0; };
  place_ = event.code;
  repeating_ = event.action == GLFW_REPEAT;
  shortcut_ = with(GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER);
  if (event.action == GLFW_RELEASE) {
    // Other modifiers may be down by now, and a field or a menu may be open.
    const auto held = held_.find(event.code);
    if (held == held_.end()) return false;
    push(commands, RunAction{held->second->name + " off"});
    held_.erase(held);
    return false;
  }
  const bool escape = event.code == GLFW_KEY_ESCAPE;
  // Esc closes a menu before anything else; in a field Dear ImGui reverts the text.
  if (escape && popup_is_open()) return close_popups(), false;
  const bool typed = listener == Listener::field && !(escape && has_field(state));
  const bool of_popup = listener == Listener::popup && types(event);
  if (with(GLFW_MOD_ALT | GLFW_MOD_SUPER) || typed || of_popup) return false;
  const Action* found = action_of_press(event);
  if (found == nullptr) return false;
  shortcut_ = true;  // a digit of the keypad types a character, too
  if (repeating_ && !found->repeats) return false;
  if (found->held) {
    held_[event.code] = found;
    push(commands, RunAction{found->name + " on"});
    return false;
  }
  push(commands, RunAction{found->name});
  return found->opens_field;
}

bool KeyCommands::type(const InputEvent& event,
                       Listener listener,
                       const WorkbenchState& state,
                       Commands& commands) {
  constexpr double kAfterField_s = 1;
  if (shortcut_ || listener != Listener::shortcuts) return false;
  const char32_t character = character_for_shortcut(event.character, place_, state);
  const bool digit = character >= U'0' && character <= U'9';
  // The user may go on typing a number for a moment after the field has closed.
  if (digit && field_s_ && event.time_s - *field_s_ < kAfterField_s) return false;
  const Action* found = action_of_character(character, &state);
  if (found == nullptr || (repeating_ && !found->repeats)) return false;
  push(commands, RunAction{found->name});
  return found->opens_field;
}

}  // namespace gpo
