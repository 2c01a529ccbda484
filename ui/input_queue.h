// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <set>
#include <string>

namespace gpo {

/// What a window is told by GLFW, in its numbers.
struct InputEvent {
  enum class Kind { key, character, button, scroll, pointer, enter, focus, drop };

  Kind kind = Kind::key;
  int code = 0;  ///< key, button; entered, focused: 0 or 1
  int scancode = 0;
  int action = 0;     ///< GLFW_PRESS, GLFW_RELEASE, GLFW_REPEAT
  int modifiers = 0;  ///< GLFW_MOD_...
  char32_t character = 0;
  double x = 0, y = 0;    ///< pointer [screen units], scroll
  std::string path = {};  ///< dropped
};

/// Who hears a key.
enum class Listener {
  nobody,    ///< a field is about to want text: keys wait for it
  field,     ///< keys are text
  popup,     ///< a menu or a combo is open: letters are no shortcuts
  shortcuts  ///< keys are commands
};

/// Events on their way to the window, frame by frame. Dear ImGui sees a key, a button as it is at a
/// frame's beginning: what goes down and up within one is lost, and what is typed before a field
/// has been drawn is not its text.
class InputQueue {
 public:
  void push(InputEvent event);
  bool empty() const { return events_.empty(); }
  /// A frame begins: every key and button may change once more.
  void begin_frame();
  /// Whether the first event belongs to this frame.
  bool has_next(Listener listener) const;
  InputEvent take();
  /// Nothing more until the next frame.
  void end_frame() { frame_ = Frame::ended; }

 private:
  /// What a frame has taken from the keyboard. A field takes a frame's characters first, and none
  /// while Ctrl is down at its end: characters after a command, and Ctrl after characters, wait for
  /// the next frame.
  enum class Frame {
    empty,
    characters,
    commands,
    characters_and_commands,  ///< in this order
    ended                     ///< takes nothing more of any kind
  };

  bool has_characters() const {
    return frame_ == Frame::characters || frame_ == Frame::characters_and_commands;
  }

  std::deque<InputEvent> events_;
  std::set<int> changed_;  ///< keys, in this frame
  Frame frame_ = Frame::empty;
  int keys_wait_ = 0;  ///< frames, after what may have given a field the keyboard, or taken it
};

/// Whether the key types a character: its going down and up does not matter to a field.
bool types(const InputEvent& event);

}  // namespace gpo
