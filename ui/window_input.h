// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/actions/actions.h"

#include <deque>
#include <map>
#include <set>
#include <string_view>

struct GLFWwindow;

namespace gpo {

struct WorkbenchState;

/// An input event of a window, in GLFW's numbers.
struct InputEvent {
  enum class Kind { key, character, button, scroll, pointer, enter, focus, drop };

  Kind kind = Kind::key;
  int code = 0;  ///< key by its place, or button; 1 if entered or focused; number of dropped files
  int scancode = 0;
  int action = 0;     ///< GLFW_PRESS, GLFW_RELEASE, GLFW_REPEAT
  int modifiers = 0;  ///< GLFW_MOD_...
  char32_t character = 0;
  double x = 0, y = 0;    ///< pointer [framebuffer px], scroll
  std::string path = {};  ///< dropped file
  int layout_key = 0;     ///< the key by what the keyboard layout has there, see `key_in_layout`
  double time_s = 0;      ///< when it happened
};

/// Returns the key that has this place on a US keyboard, with GLFW's numbers, but named by the
/// user's keyboard layout: Z for the place of Y on a German one. `name`: what the layout types
/// there, UTF-8; empty if unknown. Letters and digits that are not Latin keep their place.
int key_in_layout(int place, std::string_view name);

/// Returns whether the key types a character; then a text field ignores its press and release.
bool types(const InputEvent& event);

/// Opens the first of the files that were dropped together, and says so if there are others.
void push_drop(const InputEvent& event, Commands& commands);

enum class Listener {
  none,      ///< a text field is about to open: keys wait for it
  field,     ///< keys are text
  popup,     ///< a menu or a combo box is open: letters are no shortcuts
  shortcuts  ///< keys are commands
};

/// Distributes input events to frames of the window. Dear ImGui sees the state of keys at the
/// beginning of a frame: it misses a press and release within one, and text before its field.
class InputQueue {
 public:
  void push(InputEvent event);
  bool empty() const { return events_.empty(); }
  void begin_frame();
  /// Returns whether the first event belongs to this frame.
  bool has_next(Listener listener) const;
  InputEvent take();
  /// Leaves all further events to the next frame.
  void end_frame() { frame_ = Frame::ended; }

 private:
  /// The keyboard events that a frame took. A text field handles a frame's characters first, and
  /// ignores them while Ctrl is down at the end of the frame. So characters after a command, and
  /// Ctrl after characters, wait for the next frame.
  enum class Frame {
    empty,
    characters,
    commands,
    characters_and_commands,  ///< in this order
    ended                     ///< takes no more events
  };

  bool has_characters() const {
    return frame_ == Frame::characters || frame_ == Frame::characters_and_commands;
  }

  std::deque<InputEvent> events_;
  std::set<int> changed_;  ///< keys, in this frame
  Frame frame_ = Frame::empty;
  int keys_wait_ = 0;  ///< frames, after an event that may have opened or closed a text field
};

/// Turns keys and characters into commands.
class KeyCommands {
 public:
  /// Adds the command of a key. Returns whether it opens a text field.
  bool press(const InputEvent& event,
             Listener listener,
             const WorkbenchState& state,
             Commands& commands);
  /// The same of a typed character.
  bool type(const InputEvent& event,
            Listener listener,
            const WorkbenchState& state,
            Commands& commands);
  /// Notes an event of any kind while a text field has the keyboard.
  void note_field(const InputEvent& event) { field_s_ = event.time_s; }

 private:
  std::map<int, const Action*> held_;  ///< actions that run until their key is released
  int place_ = 0;                      ///< the key that types the next character
  bool repeating_ = false;             ///< this key is held down
  bool shortcut_ = false;              ///< this key is a shortcut, or Ctrl, Alt or Super is down
  std::optional<double> field_s_;      ///< when a text field had the keyboard last
};

/// Passes keys, mouse and dropped files of a window to Dear ImGui, and turns them into commands.
class WindowInput {
 public:
  explicit WindowInput(GLFWwindow* window);
  ~WindowInput();
  WindowInput(const WindowInput&) = delete;
  WindowInput& operator=(const WindowInput&) = delete;

  /// Passes the events of the next frame to Dear ImGui. Returns the commands among them.
  Commands dispatch(const WorkbenchState& state);
  bool waiting() const { return !queue_.empty(); }

 private:
  Listener listener(const WorkbenchState& state);
  void hand_to_imgui(const InputEvent& event);

  GLFWwindow* window_;
  InputQueue queue_;
  KeyCommands keys_;
  std::map<int, int> imgui_keys_;  ///< keys that are down, by place, as Dear ImGui knows them
  int frames_without_field_ = 0;   ///< since a text field should have opened
};

}  // namespace gpo
