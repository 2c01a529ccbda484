// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/workbench/actions/tables.h"
#include "ui/workbench/playing.h"
#include "ui/workbench/time_span.h"
#include "ui/workbench/undo.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using State = WorkbenchState;

auto frame_text(int (*frame)(const State&)) {
  return [frame](const State& s) { return s.document.recording ? std::to_string(frame(s)) : ""; };
}

void step(State& state, int frames) {
  state.view.playing = false;
  go_to_frame(state, state.view.frame + frames);
}

void play(State& state) {
  state.view.playing = !state.view.playing;
  state.view.play_seconds = 0;
  if (state.view.playing && state.view.frame + 1 >= state.frame_count()) state.view.frame = 0;
}

void add_playing(std::vector<Action>& table) {
  Action action = plain("play",
                        "Play / pause",
                        "Time",
                        {{0, false, false, U' ', "Space"}},
                        "Plays at the recording's own rate",
                        play);
  action.value = [](const State& s) { return s.view.playing ? "playing" : "paused"; };
  table.push_back(action);
}

void add_speed(std::vector<Action>& table) {
  Action speed{"speed", "Speed", "Time", {}, "Of playing, in the recording's own"};
  speed.arguments = "FACTOR";
  speed.needs_recording = false;
  speed.value = [](const State& s) { return fmt::format("{:g}\u00d7", s.view.speed); };
  speed.run = [](State& s, const Arguments& arguments) {
    expect_count("speed", arguments, 1, 1);
    s.view.speed = std::clamp(number_in("speed", arguments), 0.05, 20.0);
  };
  table.push_back(speed);
  for (const auto& [name, title, sign, factor] :
       {std::tuple{"faster", "Twice as fast", '+', 2.0}, {"slower", "Half as fast", '-', 0.5}}) {
    Action action = plain(name,
                          title,
                          "Time",
                          {letter(sign)},
                          "Changes the speed of playing",
                          [factor = factor](State& s) {
                            s.view.speed = std::clamp(s.view.speed * factor, 0.125, 8.0);
                          });
    action.value = speed.value;
    action.needs_recording = false;
    table.push_back(action);
  }
  Action loop{"loop", "Loop", "Time", {letter('L')}, "Playing repeats the window"};
  loop.arguments = "[on|off]";
  loop.needs_recording = false;
  loop.checked = [](const State& s) { return s.view.loop; };
  loop.run = [](State& s, const Arguments& arguments) {
    s.view.loop = switched("loop", arguments, s.view.loop);
  };
  table.push_back(loop);
}

std::vector<Bookmark>::iterator bookmark_from(State& state, int frame) {
  return std::ranges::lower_bound(state.document.bookmarks, frame, {}, &Bookmark::frame);
}

/// Puts one at the current frame; where there is one already, gives it another note, or without a
/// note takes it away.
void bookmark(State& state, const Arguments& arguments) {
  const std::string note = fmt::format("{}", fmt::join(arguments, " "));
  const auto at = bookmark_from(state, state.view.frame);
  if (at == state.document.bookmarks.end() || at->frame != state.view.frame)
    state.document.bookmarks.insert(at, {state.view.frame, note});
  else if (note.empty())
    state.document.bookmarks.erase(at);
  else
    at->note = note;
}

void add_bookmarks(std::vector<Action>& table) {
  Action mark{"bookmark",
              "Bookmark",
              "Time",
              {letter('M')},
              "Marks this frame, with a note if one is given; again: takes the mark away"};
  mark.arguments = "[NOTE]";
  mark.value = [](const State& s) { return std::to_string(s.document.bookmarks.size()); };
  mark.run = bookmark;
  table.push_back(mark);
  table.push_back(plain("next-bookmark",
                        "Next bookmark",
                        "Time",
                        {letter('.')},
                        "Goes to the next marked frame",
                        [](State& s) {
                          const auto next = bookmark_from(s, s.view.frame + 1);
                          if (next != s.document.bookmarks.end()) go_to_frame(s, next->frame);
                        }));
  table.push_back(plain("previous-bookmark",
                        "Previous bookmark",
                        "Time",
                        {letter(',')},
                        "Goes to the marked frame before",
                        [](State& s) {
                          const auto next = bookmark_from(s, s.view.frame);
                          if (next != s.document.bookmarks.begin())
                            go_to_frame(s, std::prev(next)->frame);
                        }));
}

void add_steps(std::vector<Action>& table) {
  struct Row {
    const char *name, *title;
    Shortcut shortcut;
    int frames;
  };
  constexpr int kAll = 1'000'000'000;
  const Row rows[] = {
      {"previous", "Previous frame", key(GLFW_KEY_LEFT, "Left"), -1},
      {"next", "Next frame", key(GLFW_KEY_RIGHT, "Right"), 1},
      {"previous-ten", "Ten frames back", key(GLFW_KEY_LEFT, "Shift+Left", true), -10},
      {"next-ten", "Ten frames on", key(GLFW_KEY_RIGHT, "Shift+Right", true), 10},
      {"first", "First frame", key(GLFW_KEY_HOME, "Home"), -kAll},
      {"last", "Last frame", key(GLFW_KEY_END, "End"), kAll}};
  for (const Row& row : rows) {
    Action action = plain(row.name,
                          row.title,
                          "Time",
                          {row.shortcut},
                          "Shows another frame; the window stays where it is",
                          [frames = row.frames](State& s) { step(s, frames); });
    action.value = frame_text([](const State& s) { return s.view.frame; });
    action.repeats = true;
    table.push_back(action);
  }
  Action frame{"frame", "Go to frame", "Time", {}, "Shows the frame with this number"};
  frame.arguments = "N";
  frame.run = [](State& s, const Arguments& arguments) {
    expect_count("frame", arguments, 1, 1);
    const int wanted = whole_number_in("frame", arguments);
    if (wanted < 0 || wanted >= s.frame_count())
      throw InputError(fmt::format("frame: {} is not in the recording, which has frames 0 to {}",
                                   wanted,
                                   s.frame_count() - 1));
    s.view.playing = false;
    go_to_frame(s, wanted);
  };
  table.push_back(frame);
}

void add_window(std::vector<Action>& table) {
  Action start = plain(
      "window-start",
      "Window starts here",
      "Time",
      {letter('[')},
      "Makes this frame the reference frame",
      [](State& s) {
        change_settings(s, start_window_at(s.document.settings, s.view.frame, s.frame_count()));
      });
  start.value = frame_text([](const State& s) { return s.document.settings.start; });
  table.push_back(start);
  Action end =
      plain("window-end",
            "Window ends here",
            "Time",
            {letter(']')},
            "Makes this frame the last of the window",
            [](State& s) {
              change_settings(s, end_window_at(s.document.settings, s.view.frame, s.frame_count()));
            });
  end.value = frame_text(
      [](const State& s) { return s.document.settings.start + s.document.settings.frames - 1; });
  table.push_back(end);
}

/// [all|window|FIRST COUNT]; without any: all, or from all to the window.
void show_time(State& s, const Arguments& arguments) {
  expect_count("time-line", arguments, 0, 2);
  if (arguments.size() == 2) {
    const int first = whole_number_in("time-line", arguments);
    const int count = whole_number_in("time-line", arguments, 1);
    if (first < 0 || count < 1 || first >= s.frame_count())
      throw InputError(fmt::format("time-line: {} {}, expected frames of the recording, 0 to {}",
                                   first,
                                   count,
                                   s.frame_count() - 1));
    s.view.time_span = zoomed({first, count}, s.frame_count(), 0, 1);
    return;
  }
  const std::string what = arguments.empty()       ? s.view.time_span.count > 0 ? "all" : "window"
                           : arguments[0] == "all" ? "all"
                           : arguments[0] == "window" ? "window"
                                                      : "";
  if (what.empty())
    throw InputError(
        fmt::format("time-line: '{}', expected all, window, or two frame numbers", arguments[0]));
  s.view.time_span =
      what == "all" ? TimeSpan{} : around_window(s.document.settings, s.frame_count());
}

void add_time_line(std::vector<Action>& table) {
  Action show{
      "time-line",
      "Time line: all, or around the window",
      "Time",
      {},
      "Which frames the time line shows; the wheel over it zooms, a double click shows all, "
      "or the window"};
  show.arguments = "[all|window|FIRST COUNT]";
  show.run = show_time;
  table.push_back(show);
}

}  // namespace

void add_time_actions(std::vector<Action>& table) {
  add_playing(table);
  add_speed(table);
  add_steps(table);
  add_window(table);
  add_time_line(table);
  add_bookmarks(table);
}

}  // namespace gpo
