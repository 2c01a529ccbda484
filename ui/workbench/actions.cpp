// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/actions.h"

#include "engine/initializers/methods.h"

#include <algorithm>
#include <utility>

#include <GLFW/glfw3.h>

namespace gpo {

namespace {

using State = WorkbenchState;

Shortcut key(int glfw_key, std::string label, bool shift = false) {
  return {glfw_key, shift, false, 0, std::move(label)};
}

Shortcut letter(char character) {
  const char lower = character >= 'A' && character <= 'Z' ? char(character - 'A' + 'a') : character;
  return {0, false, false, static_cast<char32_t>(lower), std::string(1, character)};
}

auto frame_text(int (*frame)(const State&)) {
  return [frame](const State& s) { return s.recording ? std::to_string(frame(s)) : ""; };
}

void step(State& state, int frames) {
  state.playing = false;
  apply(state, GoToFrame{state.frame + frames});
}

void play(State& state) {
  state.playing = !state.playing;
  state.play_seconds = 0;
  if (state.playing && state.frame + 1 >= state.frame_count()) state.frame = 0;
}

void escape(State& state) {
  if (state.show_help) {
    state.show_help = false;
  } else {
    state.wishes.cancel = true;
  }
}

/// Off, as it is, enlarged 10 and 100 times, off.
void enlarge_uncertainty(ViewToggles& view) {
  view.uncertainty = view.uncertainty == 0     ? 1
                     : view.uncertainty >= 100 ? 0
                                               : 10 * view.uncertainty;
}

std::string uncertainty_text(const ViewToggles& view) {
  if (view.uncertainty > 1) return "\u00d7" + std::to_string(view.uncertainty);
  return view.uncertainty == 1 ? "on" : "off";
}

Action toggle(std::string name,
              std::string title,
              std::vector<Shortcut> shortcuts,
              std::string tooltip,
              bool ViewToggles::*flag) {
  Action action{
      std::move(name), std::move(title), "View", std::move(shortcuts), std::move(tooltip)};
  action.run = [flag](State& s) { s.view.*flag = !(s.view.*flag); };
  action.checked = [flag](const State& s) { return s.view.*flag; };
  action.needs_recording = false;
  return action;
}

Action move(std::string name,
            std::string title,
            Shortcut shortcut,
            std::function<void(State&)> run) {
  Action action{std::move(name), std::move(title), "Time", {std::move(shortcut)}, ""};
  action.tooltip = "Shows another frame; the window stays where it is";
  action.run = std::move(run);
  action.value = frame_text([](const State& s) { return s.frame; });
  action.repeats = true;
  return action;
}

void add_file_actions(std::vector<Action>& table) {
  Action example{"open-example",
                 "Open the example",
                 "File",
                 {},
                 "Opens the recording that comes with the program",
                 [](State& s) { s.wishes.open_example = true; }};
  example.needs_recording = false;
  table.push_back(example);
  table.push_back({"save-picture",
                   "Save the picture",
                   "File",
                   {letter('S')},
                   "Writes the current frame with its overlays as a PNG into the current folder",
                   [](State& s) { s.wishes.save_picture = true; }});
  Action quit{"quit",
              "Quit",
              "File",
              {{GLFW_KEY_Q, false, true, 0, "Ctrl+Q"}},
              "Closes the window",
              [](State& s) { s.wishes.quit = true; }};
  quit.needs_recording = false;
  table.push_back(quit);
}

void add_view_actions(std::vector<Action>& table) {
  table.push_back(toggle(
      "tracks", "Tracks", {}, "Inliers as circles, outliers as crosses", &ViewToggles::tracks));
  table.push_back(toggle("tails",
                         "Tails",
                         {letter('T')},
                         "Where each track came from in the last frames",
                         &ViewToggles::tails));
  table.push_back(toggle("residuals",
                         "Residual vectors",
                         {letter('E')},
                         "From where a track is seen to where the result puts it, enlarged",
                         &ViewToggles::residuals));
  table.push_back(toggle("cube",
                         "Cube",
                         {letter('B')},
                         "A cube that stands on the estimated plane",
                         &ViewToggles::cube));
  table.push_back(toggle("truth",
                         "Ground truth",
                         {letter('G')},
                         "True cameras, plane and cube in gray, where they are known",
                         &ViewToggles::truth));
  Action uncertainty{"uncertainty",
                     "Uncertainty",
                     "View",
                     {letter('U')},
                     "95 % of camera centers and normal in the scene; again: enlarged 10 and 100 "
                     "times, then off",
                     [](State& s) { enlarge_uncertainty(s.view); }};
  uncertainty.checked = [](const State& s) { return s.view.uncertainty > 0; };
  uncertainty.value = [](const State& s) { return uncertainty_text(s.view); };
  uncertainty.needs_recording = false;
  table.push_back(uncertainty);
  table.push_back({"fit",
                   "Fit view",
                   "View",
                   {letter('F')},
                   "Shows all of the picture and all of the scene",
                   [](State& s) {
                     s.picture_zoom = {};
                     s.orbit.reset();
                   }});
}

void add_time_actions(std::vector<Action>& table) {
  Action play_action{"play",
                     "Play / pause",
                     "Time",
                     {{0, false, false, U' ', "Space"}},
                     "Plays at the recording's own rate",
                     play};
  play_action.value = [](const State& s) { return s.playing ? "playing" : "paused"; };
  table.push_back(play_action);
  table.push_back(move(
      "previous", "Previous frame", key(GLFW_KEY_LEFT, "Left"), [](State& s) { step(s, -1); }));
  table.push_back(
      move("next", "Next frame", key(GLFW_KEY_RIGHT, "Right"), [](State& s) { step(s, 1); }));
  table.push_back(
      move("previous-ten", "Ten frames back", key(GLFW_KEY_LEFT, "Shift+Left", true), [](State& s) {
        step(s, -10);
      }));
  table.push_back(
      move("next-ten", "Ten frames on", key(GLFW_KEY_RIGHT, "Shift+Right", true), [](State& s) {
        step(s, 10);
      }));
  table.push_back(move(
      "first", "First frame", key(GLFW_KEY_HOME, "Home"), [](State& s) { step(s, -s.frame); }));
  table.push_back(move(
      "last", "Last frame", key(GLFW_KEY_END, "End"), [](State& s) { step(s, s.frame_count()); }));
  Action start{
      "window-start",
      "Window starts here",
      "Time",
      {letter('[')},
      "Makes this frame the reference frame",
      [](State& s) { s.settings = start_window_at(s.settings, s.frame, s.frame_count()); }};
  start.value = frame_text([](const State& s) { return s.settings.start; });
  table.push_back(start);
  Action end{"window-end",
             "Window ends here",
             "Time",
             {letter(']')},
             "Makes this frame the last of the window",
             [](State& s) { s.settings = end_window_at(s.settings, s.frame, s.frame_count()); }};
  end.value = frame_text([](const State& s) { return s.settings.start + s.settings.frames - 1; });
  table.push_back(end);
}

void add_method_actions(std::vector<Action>& table) {
  for (std::size_t i = 0; i < std::min<std::size_t>(9, methods().size()); ++i) {
    const Method& method = methods()[i];
    const std::string number = std::to_string(i + 1);
    Action action{"method-" + number,
                  method.title,
                  "Method",
                  {letter(number.front())},
                  "Initializes with " + method.title,
                  [method_key = method.key](State& s) { s.settings.method = method_key; }};
    action.checked = [method_key = method.key](const State& s) {
      return s.settings.method == method_key;
    };
    action.needs_recording = false;
    table.push_back(action);
  }
  Action ransac{"ransac",
                "RANSAC",
                "Method",
                {letter('R')},
                "Rejects outliers by a homography from the reference frame",
                [](State& s) { s.settings.ransac = !uses_ransac(s.settings); }};
  ransac.checked = [](const State& s) { return uses_ransac(s.settings); };
  ransac.needs_recording = false;
  table.push_back(ransac);
  table.push_back({"compute",
                   "Compute again",
                   "Method",
                   {key(GLFW_KEY_F5, "F5")},
                   "Computes with the same settings, say after Esc",
                   [](State& s) { s.wishes.compute = true; }});
}

void add_help_actions(std::vector<Action>& table) {
  Action help{"help",
              "Keys",
              "Help",
              {key(GLFW_KEY_F1, "F1"), letter('?')},
              "Lists every key and its state",
              [](State& s) { s.show_help = !s.show_help; }};
  help.checked = [](const State& s) { return s.show_help; };
  help.needs_recording = false;
  table.push_back(help);
  Action esc{"escape",
             "Cancel, or close what is open",
             "Help",
             {key(GLFW_KEY_ESCAPE, "Esc")},
             "Closes the list of keys, else stops the computation",
             escape};
  esc.needs_recording = false;
  table.push_back(esc);
}

std::vector<Action> make_actions() {
  std::vector<Action> table;
  add_file_actions(table);
  add_view_actions(table);
  add_time_actions(table);
  add_method_actions(table);
  add_help_actions(table);
  return table;
}

template <class Matches>
const Action* find_shortcut(Matches&& matches) {
  for (const Action& action : actions()) {
    if (std::any_of(action.shortcuts.begin(), action.shortcuts.end(), matches)) return &action;
  }
  return nullptr;
}

}  // namespace

std::span<const Action> actions() {
  static const std::vector<Action> table = make_actions();
  return table;
}

const Action* find_action(const std::string& name) {
  const auto table = actions();
  const auto found = std::find_if(
      table.begin(), table.end(), [&](const Action& action) { return action.name == name; });
  return found == table.end() ? nullptr : &*found;
}

const Action* action_of_key(int glfw_key, bool shift, bool control) {
  return find_shortcut([&](const Shortcut& s) {
    return s.character == 0 && s.key == glfw_key && s.shift == shift && s.control == control;
  });
}

const Action* action_of_character(char32_t character) {
  const char32_t lower =
      character >= U'A' && character <= U'Z' ? character - U'A' + U'a' : character;
  return find_shortcut([&](const Shortcut& s) { return s.character != 0 && s.character == lower; });
}

bool enabled(const Action& action, const WorkbenchState& state) {
  return state.recording || !action.needs_recording;
}

void run_action(WorkbenchState& state, const std::string& name) {
  const Action* action = find_action(name);
  if (!action) {
    state.message = "no action is called \"" + name + "\"";
  } else if (!enabled(*action, state)) {
    state.message = "no recording is open";
  } else {
    action->run(state);
  }
}

}  // namespace gpo
