// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/methods/methods.h"
#include "engine/pipeline/method_defaults.h"
#include "ui/workbench/actions/actions.h"

#include <algorithm>
#include <span>
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

void add_playing(const MenuRows& menu) {
  Action& action = menu.plain({"play", "Play / pause", "Plays at the frame rate of the recording"},
                              [](State& s) {
                                s.view.playing = !s.view.playing;
                                s.view.play_seconds = 0;
                                if (s.view.playing && s.view.frame + 1 >= s.frame_count())
                                  s.view.frame = 0;
                              });
  action.shortcuts = {{.character = U' ', .label = "Space"}};
  action.value = [](const State& s) { return s.view.playing ? "playing" : "paused"; };
  const auto speed_text = [](const State& s) { return fmt::format("{:g}\u00d7", s.view.speed); };
  menu.anytime()
      .add({"speed", "Speed", "Sets the playback speed as a multiple of real time"},
           "FACTOR",
           [](State& s, const Arguments& arguments) {
             s.view.speed = arguments.number_within(0.05, 20);
           })
      .value = speed_text;
  for (const auto& [name, title, sign, factor] :
       {std::tuple{"faster", "Twice as fast", '+', 2.0}, {"slower", "Half as fast", '-', 0.5}}) {
    Action& change = menu.anytime().plain(
        {name, title, "Changes the playback speed"}, [factor = factor](State& s) {
          s.view.speed = std::clamp(s.view.speed * factor, 0.125, 8.0);
        });
    change.shortcuts = {letter(sign)};
    change.value = speed_text;
  }
  menu.toggle({"loop", "Loop", "Repeats the window while playing"},
              [](State& s) -> bool& { return s.view.loop; })
      .shortcuts = {letter('L')};
}

std::vector<Bookmark>::iterator bookmark_from(State& state, int frame) {
  return std::ranges::lower_bound(state.document.bookmarks, frame, {}, &Bookmark::frame);
}

/// Returns the number of a frame of the recording among the arguments.
int frame_named(const State& s, const Arguments& arguments) {
  const int frame = arguments.whole_number();
  if (frame >= 0 && frame < s.frame_count()) return frame;
  throw InputError(fmt::format("{}: {} is outside of the recording, expected 0 to {}",
                               arguments.action,
                               frame,
                               s.frame_count() - 1));
}

/// Again: changes the note or, without a note, removes the bookmark.
void bookmark(State& state, int frame, std::span<const std::string> words) {
  const std::string note = fmt::format("{}", fmt::join(words, " "));
  const auto at = bookmark_from(state, frame);
  if (at == state.document.bookmarks.end() || at->frame != frame)
    state.document.bookmarks.insert(at, {frame, note});
  else if (note.empty())
    state.document.bookmarks.erase(at);
  else
    at->note = note;
}

void add_bookmarks(const MenuRows& menu) {
  Action& mark = menu.add(
      {"bookmark", "Bookmark", "Bookmarks this frame, with an optional note; again: removes it"},
      "[NOTE ...]",
      [](State& s, const Arguments& a) { bookmark(s, s.view.frame, a.words); });
  mark.shortcuts = {letter('M')};
  mark.value = [](const State& s) { return std::to_string(s.document.bookmarks.size()); };
  menu.add({"bookmark-at", "Bookmark a frame", "Bookmarks a frame, with an optional note"},
           "N [NOTE ...]",
           [](State& s, const Arguments& a) {
             bookmark(s, frame_named(s, a), std::span(a.words).subspan(1));
           });
  menu.plain({"next-bookmark", "Next bookmark", "Goes to the next bookmark"},
             [](State& s) {
               const auto next = bookmark_from(s, s.view.frame + 1);
               if (next != s.document.bookmarks.end()) go_to_frame(s, next->frame);
             })
      .shortcuts = {letter('.')};
  menu.plain({"previous-bookmark", "Previous bookmark", "Goes to the previous bookmark"},
             [](State& s) {
               const auto next = bookmark_from(s, s.view.frame);
               if (next != s.document.bookmarks.begin()) go_to_frame(s, std::prev(next)->frame);
             })
      .shortcuts = {letter(',')};
}

void add_steps(const MenuRows& menu) {
  struct Row {
    const char *name, *title;
    Shortcut shortcut;
    int frames;
  };
  constexpr int kAll = 1'000'000'000;
  for (const Row& row :
       {Row{"previous", "Previous frame", key(GLFW_KEY_LEFT, "Left"), -1},
        {"next", "Next frame", key(GLFW_KEY_RIGHT, "Right"), 1},
        {"previous-ten", "Ten frames back", key(GLFW_KEY_LEFT, "Shift+Left", true), -10},
        {"next-ten", "Ten frames forward", key(GLFW_KEY_RIGHT, "Shift+Right", true), 10},
        {"first", "First frame", key(GLFW_KEY_HOME, "Home"), -kAll},
        {"last", "Last frame", key(GLFW_KEY_END, "End"), kAll}}) {
    Action& action =
        menu.plain({row.name, row.title, "Shows another frame without moving the window"},
                   [frames = row.frames](State& s) {
                     s.view.playing = false;
                     go_to_frame(s, s.view.frame + frames);
                   });
    action.shortcuts = {row.shortcut};
    action.value = frame_text([](const State& s) { return s.view.frame; });
    action.repeats = true;
  }
  menu.add({"frame", "Go to frame", "Shows the frame with this number"},
           "N",
           [](State& s, const Arguments& arguments) {
             const int frame = frame_named(s, arguments);
             s.view.playing = false;
             go_to_frame(s, frame);
           });
}

void add_window(const MenuRows& menu) {
  const auto add = [&](Action action, Settings (*moved)(Settings, int, int)) -> Action& {
    return menu.add(std::move(action), "[N]", [moved](State& s, const Arguments& a) {
      const int frame = a.empty() ? s.view.frame : frame_named(s, a);
      change_settings(s, moved(s.document.settings, frame, s.frame_count()));
    });
  };
  Action& start = add({"window-start",
                       "Window starts here",
                       "Makes this frame, or the one with this number, the reference frame"},
                      start_window_at);
  start.shortcuts = {letter('[')};
  start.value = frame_text([](const State& s) { return s.document.settings.start; });
  Action& end = add({"window-end",
                     "Window ends here",
                     "Makes this frame, or the one with this number, the last of the window"},
                    end_window_at);
  end.shortcuts = {letter(']')};
  end.value = frame_text(
      [](const State& s) { return s.document.settings.start + s.document.settings.frames - 1; });
}

void show_time(State& s, const Arguments& arguments) {
  const int last = s.frame_count() - 1;
  if (arguments.size() == 2) {
    const int first = arguments.whole_number(0), count = arguments.whole_number(1);
    if (first < 0 || count < 1 || first > last)
      throw InputError(
          fmt::format("time-line: {} {}, expected frames from 0 to {}", first, count, last));
    s.view.time_span = zoomed({first, count}, s.frame_count(), 0, 1);
    return;
  }
  const std::string part = !arguments.empty()           ? arguments[0]
                           : s.view.time_span.count > 0 ? "all"
                                                        : "window";
  if (part != "all" && part != "window")
    throw InputError(
        fmt::format("time-line: '{}', expected all, window or two frame numbers", part));
  s.view.time_span =
      part == "all" ? TimeSpan{} : around_window(s.document.settings, s.frame_count());
}

void add_settings(const MenuRows& menu) {
  Action& ransac =
      menu.plain({"ransac", "RANSAC", "Rejects outliers by a homography from the reference frame"},
                 [](State& s) {
                   const Settings& now = s.document.settings;
                   change_settings(s, switched(now, "ransac", !uses_ransac(now.options)));
                 });
  ransac.shortcuts = {letter('R')};
  ransac.checked = [](const State& s) { return uses_ransac(s.document.settings.options); };
  const auto add = [&](Action action,
                       const char* arguments,
                       Settings (*changed)(const State&, const Arguments&)) {
    menu.add(std::move(action), arguments, [changed](State& s, const Arguments& a) {
      change_settings(s, changed(s, a));
    });
  };
  add({"set", "Change a setting", "Gives a setting another value"},
      "SETTING VALUE",
      [](const State& s, const Arguments& a) {
        return with_setting(s.document.settings, a[0], a[1], s.methods);
      });
  add({"preset",
       "Choose a preset",
       "Changes all settings but the window to the best known ones or to those of the paper"},
      "best|paper",
      [](const State& s, const Arguments& a) {
        return with_preset(s.document.settings, choice<Preset>(a[0]));
      });
  add({"reset",
       "Reset settings",
       "Resets one setting, or all of them including window and method, to its default"},
      "[SETTING]",
      [](const State& s, const Arguments& a) {
        return a.empty() ? Settings{} : with_default(s.document.settings, a[0]);
      });
}

/// A camera that a file describes is not replaced by one estimated from the images.
void request_calibration(State& s) {
  if (!s.document.recording->images) throw InputError("calibrate: the recording has no images");
  if (s.document.recording->camera_source == CameraSource::file)
    throw InputError("calibrate: the recording has a calibration file, which takes precedence");
  s.requests.calibrate = true;
}

}  // namespace

void add_time_actions(std::vector<Action>& table) {
  const MenuRows menu{table, "Time"};
  add_playing(menu);
  add_steps({table, "Time", "Go to"});
  add_window(menu);
  menu.add({"time-line",
            "Zoom the time line",
            "Shows all frames or those around the window in the time line; so do the mouse wheel "
            "and a double click on it"},
           "[all|window|FIRST COUNT]",
           show_time);
  add_bookmarks(menu);
}

Action choice_of_method(const MethodChoice& method) {
  std::vector<Action> table;
  Action& action = MenuRows{table, "Method"}.anytime().plain(
      {"method " + method.key(), method.row().title, method.row().help}, [method](State& s) {
        Settings settings = s.document.settings;
        settings.options.method = method;
        change_settings(s, settings);
      });
  action.checked = [method](const State& s) {
    return s.document.settings.options.method == method;
  };
  return action;
}

void add_method_actions(std::vector<Action>& table) {
  for (std::size_t i = 0; i < methods().size(); ++i) {
    table.push_back(choice_of_method(methods()[i].key));
    if (i < 9) table.back().shortcuts.push_back(letter(static_cast<char>('1' + i)));
  }
  const MenuRows menu{table, "Method"};
  add_settings(menu.anytime());
  menu.plain({"compute", "Compute again", "Computes again with the same settings"},
             [](State& s) { s.requests.compute = true; })
      .shortcuts = {key(GLFW_KEY_F5, "F5")};
  menu.plain({"calibrate",
              "Calibrate from the plane",
              "Estimates the camera of a recording without calibration from its images (about "
              "30 s) and saves it for the next time"},
             request_calibration);
  menu.plain({"accept-calibration",
              "Accept the calibration",
              "Keeps the camera estimated last and closes its report"},
             [](State& s) {
               if (!s.results.calibration) throw InputError("no calibration is to be accepted");
               s.results.calibration.reset();
               say(s, "calibration accepted");
             });
  menu.plain({"undo-calibration",
              "Go back to the camera before",
              "Discards the camera estimated last, also for the next time"},
             [](State& s) {
               if (!s.results.calibration) throw InputError("no calibration is to be discarded");
               s.requests.undo_calibration = true;
             });
  menu.plain(
      {"find-start",
       "Find a start",
       "Initializes from start frames all over the recording and goes to the earliest one that "
       "is ready, else to the one with the lowest uncertainty"},
      [](State& s) {
        s.view.toggles.scan = true;  // its progress can be watched
        s.requests.find_start = true;
      });
}

}  // namespace gpo
