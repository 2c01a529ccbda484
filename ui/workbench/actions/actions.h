// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/workbench/state.h"

#include <functional>
#include <string_view>

namespace gpo {

/// A key or, if `character` is not 0, whatever key types it on the user's keyboard layout.
struct Shortcut {
  int key = 0;  ///< GLFW_KEY_* by the keyboard layout, see `key_in_layout`
  bool shift = false;
  bool control = false;
  char32_t character = 0;  ///< lower case
  std::string label = {};  ///< for people
};

/// The words after an action's name. The readers throw InputError that names the action.
struct Arguments {
  std::string action;
  std::vector<std::string> words;

  bool empty() const { return words.empty(); }
  std::size_t size() const { return words.size(); }
  const std::string& operator[](std::size_t i) const { return words[i]; }
  double number(std::size_t i = 0) const;
  double number_within(double least, double most, std::size_t i = 0) const;
  int whole_number(std::size_t i = 0) const;
  /// Reads "on" or "off"; toggles `now` if there is no word at `i`.
  bool on_off(bool now, std::size_t i = 0) const;
  /// Reads FACTOR [X Y]: enlarged around a pixel, by default the center of the image.
  ImageZoom zoom(const Recording& recording) const;
};

/// A named action. Keys, menus, palette, help window, scripts and tests read the table.
struct Action {
  std::string name;     ///< one or more words: "frame", "select track"
  std::string title;    ///< for people
  std::string tooltip;  ///< one sentence
  std::vector<Shortcut> shortcuts = {};
  /// Throws InputError for arguments that it cannot use.
  std::function<void(WorkbenchState&, const Arguments&)> run = {};
  std::string arguments = {};  ///< "FILE [VIEW]": optional ones in brackets, "..." for any number
  std::string menu = {};       ///< File, Edit, View, Time, Method, Help
  std::string submenu = {};    ///< empty: directly in `menu`
  std::function<std::string(const WorkbenchState&)> value = {};  ///< for the help window
  std::function<bool(const WorkbenchState&)> checked = {};       ///< null: not a switch
  bool needs_recording = true;
  bool repeats = false;       ///< while its key is held
  bool held = false;          ///< runs with "on" on key press and with "off" on release
  bool opens_field = false;   ///< moves the keyboard focus to a text field
  bool opens_device = false;  ///< may open a camera or the network, so no script runs it
  /// Its keys are another action's while this is false; null: they are always its own.
  std::function<bool(const WorkbenchState&)> takes_keys = {};

  /// Can be run by its name alone.
  bool complete() const { return arguments.empty() || arguments.front() == '['; }
};

/// The table of all actions, without those that choose one of the user's own methods.
std::span<const Action> actions();
/// The table including the user's own methods.
std::vector<Action> all_actions(const WorkbenchState& state);

/// Null if no action has that name.
const Action* find_action(const std::string& name);
/// For names in the source. Throws std::logic_error if no action has that name.
const Action& action_named(std::string_view name);

/// The action of a key without Alt or Super, by the keyboard layout; null if it has none.
const Action* action_of_key(int glfw_key, bool shift, bool control = false);
/// The same of a typed character. `state`: null for a workbench in which no action `takes_keys`.
const Action* action_of_character(char32_t typed, const WorkbenchState* state = nullptr);

bool enabled(const Action& action, const WorkbenchState& state);

/// Returns whether its first argument is a file or a folder, to be chosen in the file browser.
bool takes_a_file(const Action& action);

/// The actions of which all words are in name, title and menu, in synonyms or in the tooltip; in
/// this order, but names that begin with the text first.
std::vector<Action> find_actions(const std::string& text, const WorkbenchState& state);

struct ActionCall {
  const Action* action;
  Arguments arguments;
};
/// Parses a line by the longest action name that it begins with; nullopt if there is none.
std::optional<ActionCall> match_line(const std::string& line);

/// Runs a line: an action's name and arguments, with spaces in double quotes. Throws InputError.
void run_line(WorkbenchState& state, const std::string& line);

/// Runs a line for the user at the window: errors go to the message line.
void run_action(WorkbenchState& state, const std::string& line);

struct ScriptLine {
  int number = 0;    ///< in its file, counts from 1
  std::string text;  ///< for `run_line`
};
/// Reads one command per line, without empty lines and comments (#). Throws InputError.
std::vector<ScriptLine> read_script(const fs::path& file);

/// Reads "WIDTHxHEIGHT", 16 to 8192 pixels. The InputError begins with `requested_by`.
cv::Size image_size(const std::string& text, const std::string& requested_by);

/// Everything a user can do is a function of the state. Panels only push commands: keys, menus and
/// tests use `apply`, too.
using Command = std::function<void(WorkbenchState&)>;

struct RunAction {
  std::string line;  ///< a line of a script: an action's name and arguments, see `run_line`
  void operator()(WorkbenchState& state) const { run_action(state, line); }
};
struct ChangeSettings {
  Settings settings;
  double drag = 0;  ///< see `change_settings`
  void operator()(WorkbenchState& state) const { change_settings(state, settings, drag); }
};
struct GoToFrame {
  int frame;
  void operator()(WorkbenchState& state) const { go_to_frame(state, frame); }
};
struct SetCubeSide {
  double side;
  double drag = 0;  ///< see `change_settings`
  void operator()(WorkbenchState& state) const { change_cube_side(state, side, drag); }
};
template <class T, T ViewState::*member>
struct SetView {
  T value;
  void operator()(WorkbenchState& state) const { state.view.*member = value; }
};
using ZoomImage = SetView<ImageZoom, &ViewState::image_zoom>;
using ZoomCompare = SetView<std::optional<ImageZoom>, &ViewState::compare_zoom>;
using ZoomNormals = SetView<NormalsZoom, &ViewState::normals_zoom>;
using OrbitScene = SetView<std::optional<OrbitCamera>, &ViewState::orbit>;
using DivideWindow = SetView<Division, &ViewState::division>;
struct OpenPath {
  fs::path path;
  void operator()(WorkbenchState& state) const { state.requests.open = path; }
};
struct HoverOver {
  Hover hover;
  void operator()(WorkbenchState& state) const { state.hover = hover; }
};
struct SelectTracks {
  Selection selection;
  void operator()(WorkbenchState& state) const { state.selection = selection; }
};

/// Moves a cube to a pixel X Y of the current frame, or to a ray X Y Z [PLANE] of the reference
/// camera. Throws InputError.
void put_cube(WorkbenchState& state, const Arguments& arguments);

/// Commands collected while a frame is drawn, to be applied after it.
using Commands = std::vector<Command>;
inline void push(Commands& commands, Command command) { commands.push_back(std::move(command)); }
inline void apply(WorkbenchState& state, const Command& command) { command(state); }

// The rows of `actions()`, one function a menu.
void add_file_actions(std::vector<Action>& table);
void add_edit_actions(std::vector<Action>& table);
void add_point_actions(std::vector<Action>& table);
void add_mask_actions(std::vector<Action>& table);  ///< a part of the menu Edit
void add_view_actions(std::vector<Action>& table);
void add_time_actions(std::vector<Action>& table);
void add_method_actions(std::vector<Action>& table);
void add_finding_actions(std::vector<Action>& table);  ///< a part of the menu Method
void add_help_actions(std::vector<Action>& table);
Action choice_of_method(const MethodChoice& method);

/// Appends rows of a menu to the table. A returned row may be completed until the next is added.
struct MenuRows {
  std::vector<Action>& table;
  const char* menu;
  const char* submenu = "";
  bool needs_recording = true;

  /// The same menu for actions that need no recording.
  MenuRows anytime() const {
    MenuRows rows = *this;
    rows.needs_recording = false;
    return rows;
  }
  Action& add(Action action) const;
  /// Adds an action with arguments, described as in `Action`.
  Action& add(Action action,
              const char* arguments,
              std::function<void(WorkbenchState&, const Arguments&)> run) const;
  Action& plain(Action action, std::function<void(WorkbenchState&)> run) const;
  /// Adds a switch: "on" and "off" set it, without an argument it toggles.
  Action& toggle(Action action, const std::function<bool&(WorkbenchState&)>& flag) const;
};

/// The shortcut of a key without modifiers, or with Shift.
Shortcut key(int glfw_key, std::string label, bool shift = false);
Shortcut letter(char character);
Shortcut control(char letter);

/// The kinds of things that have a context menu.
enum class ContextKind { track, plane, point, number, frame, area };

/// The thing under the mouse when its context menu was opened.
struct ContextSubject {
  ContextKind kind = ContextKind::track;
  std::string title = {};                  ///< one line above the entries
  std::int64_t track = 0;                  ///< id
  int plane = 0;                           ///< number in the window, counts from 0
  std::optional<Vector3d> ray = {};        ///< from the reference camera to the plane's point
  std::string why_not_there = {};          ///< why there is no `ray`
  Vector2d raw_px = Vector2d::Zero();      ///< the pixel of a point
  int frame = 0;                           ///< counts in the recording
  std::string value = {}, uncertain = {};  ///< texts of a number; `uncertain` with its uncertainty
};

/// An entry of the context menus of one kind. Each runs an action.
struct ContextEntry {
  ContextKind kind;
  const char* title;  ///< for people
  /// Returns the line to run; empty if the entry is not available.
  std::string (*line)(const WorkbenchState&, const ContextSubject&);
};
std::span<const ContextEntry> context_entries();

/// Returns a text as one argument of a script's line.
std::string as_argument(const std::string& text);

/// The subject of a plane. `point` is in the reference camera's world; nullopt if the mouse is
/// beside the plane.
ContextSubject plane_subject(const Inspection& inspection,
                             int number,
                             const std::optional<Vector3d>& point);

/// The subject of a pixel of the current frame.
ContextSubject point_subject(const Vector2d& raw_px);

/// The subject of a track of the current inspection, with the reason for its rejection.
ContextSubject track_subject(const Inspection& inspection, std::int64_t id);

}  // namespace gpo
