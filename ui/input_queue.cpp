// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/input_queue.h"

#include <utility>

#include <GLFW/glfw3.h>

namespace gpo {
namespace {

using Kind = InputEvent::Kind;

/// Dear ImGui says that a field wants text in the frame after the next one, and as late that it
/// does no longer.
constexpr int kFramesToFocus = 3;

bool is_of_keyboard(const InputEvent& event) {
  return event.kind == Kind::key || event.kind == Kind::character;
}

/// Opens, shuts or leaves a field.
bool acts(int key) {
  return key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER || key == GLFW_KEY_TAB ||
         key == GLFW_KEY_ESCAPE;
}

}  // namespace

bool types(const InputEvent& event) {
  constexpr int kCommands = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
  return event.kind == Kind::key && event.code >= GLFW_KEY_SPACE &&
         event.code <= GLFW_KEY_WORLD_2 && (event.modifiers & kCommands) == 0;
}

namespace {

bool is_modifier(int key) { return key >= GLFW_KEY_LEFT_SHIFT && key <= GLFW_KEY_RIGHT_SUPER; }
bool is_shift(int key) { return key == GLFW_KEY_LEFT_SHIFT || key == GLFW_KEY_RIGHT_SHIFT; }

/// Goes down and types nothing: Ctrl, an arrow, Backspace, Ctrl with a letter.
bool is_command(const InputEvent& event) {
  return event.kind == Kind::key && event.action != GLFW_RELEASE && !types(event) &&
         !is_shift(event.code);
}

}  // namespace

void InputQueue::push(InputEvent event) {
  // Where the pointer was between two frames nobody asks.
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
  if (is_of_keyboard(next) && (listener == Listener::nobody || keys_wait_ > 0)) return false;
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
  // What comes after a click or Enter belongs to what it has done.
  const bool entered = event.kind == Kind::key && event.action != GLFW_RELEASE && acts(event.code);
  if (event.kind == Kind::button || entered) {
    frame_ = Frame::ended;
    keys_wait_ = kFramesToFocus;
  }
  return event;
}

}  // namespace gpo
