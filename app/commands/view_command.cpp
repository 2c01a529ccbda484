// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "engine/base/error.h"
#include "ui/window_input.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <algorithm>
#include <chrono>

#include <GLFW/glfw3.h>

namespace gpo {
namespace {

using Clock = std::chrono::steady_clock;

/// Dear ImGui needs some frames to size what it opens: the window sleeps after equal ones.
constexpr int kEqualFrames = 2;
constexpr int kMaxFramesAfterEvent = 30;  // a text field's blinking cursor never settles
constexpr double kIdle_s = 3600;
constexpr const char* kTitle = "GPO Inspector";

struct ViewArguments {
  InspectArguments inspect;
  std::optional<fs::path> session, script;
  std::optional<std::string> live;  ///< a camera, a stream or a recording to be played
};

struct Session {
  OwnMethods& own;
  std::string title = kTitle;
  WindowContext window{title, 1280, 720};
  WindowInput input{window.glfw()};
  Gui gui{window};
  WorkbenchHost host;
  fs::path script_file;
  std::deque<ScriptLine> script;  ///< its lines that are left
  bool runs_script = false;       ///< until the results of its last line are computed
  std::string script_place = {};  ///< file and line before an error of that line
  Clock::time_point last = Clock::now();
  double seconds = 0;  ///< between the last two iterations of the loop
  SessionSaver saver;
  std::shared_ptr<const Recording> opened;  ///< when the session was noted as changed last

  Session(const InspectArguments& from, OwnMethods& methods)
      : own(methods),
        host(
            gui, opener_for_window(from.cache_mib, given_recording(from)), example_recording(), [] {
              glfwPostEmptyEvent();
            }) {
    own.log->on_change([] { glfwPostEmptyEvent(); });
    host.live.hooks.source = live_source;
    host.live.hooks.camera_of = camera_of_source;
    host.live.hooks.opened = opened_for_window;
    host.state.methods = own.table;
    host.link.read_methods = session_methods(own, [this](const OwnMethods& added) {
      if (!added.waiting.empty()) ask_for_commands();
    });
  }
  ~Session() { own.log->on_change({}); }

  void ask_for_commands() {
    constexpr std::size_t kMaxLength = 4000;
    constexpr double kInterval_s = 0.1;
    std::vector<std::string> shown;
    for (const std::string& one : own.waiting) shown.push_back(legible(one, kMaxLength));
    std::optional<bool> answer;
    while (!answer && !window.should_close() && !current_stop().stop_requested()) {
      const cv::Size size = window.size();
      window.bind();
      input.dispatch(host.state);
      if (size.width > 0 && size.height > 0) answer = gpo::ask_for_commands(gui, size, shown);
      window.swap();
      if (!answer) glfwWaitEventsTimeout(kInterval_s);
    }
    *own.allowed = answer.value_or(false);
    if (!*own.allowed) report_not_started(own);
  }

  /// Draws a frame. Returns whether it gave commands, which the next frame has to show.
  bool draw() {
    host.size = window.size();
    if (host.size.width < 1 || host.size.height < 1) return false;  // minimized
    gui.set_screen_scale(window.content_scale());  // Wayland reports it after the window is shown
    window.bind();
    const Commands commands = host.draw(seconds);
    window.swap();
    host.live.note_shown(host.state);
    for (const Command& command : commands) apply(host.state, command);
    if (!commands.empty()) saver.note_change();
    return !commands.empty();
  }

  void update_title() {
    const auto& recording = host.state.document.recording;
    std::string now = recording ? recording->name + " \u2013 " : "";
    if (host.state.live) now = "live: " + now;
    if (recording && recording->camera_source == CameraSource::guess)
      now += "the camera is a guess \u2013 ";
    if (host.link.loading)
      now = fmt::format(
          "opening {} \u2013 ",
          (host.link.opening.empty() ? host.link.example : host.link.opening).filename().string());
    else if (host.link.worker.busy)
      now += "computing \u2013 ";
    now += kTitle;
    if (now == title) return;
    title = now;
    glfwSetWindowTitle(window.glfw(), title.c_str());
  }

  /// Sleeps until an event or the next frame. Time advances first: playback excludes the sleep.
  void wait(bool settled) {
    const auto due = seconds_to_next_frame(host.state);
    if ((due || settled) && !host.writing()) {
      const double next = std::min({due.value_or(kIdle_s),
                                    seconds_of_message(host.state).value_or(kIdle_s),
                                    saver.seconds_left().value_or(kIdle_s)});
      glfwWaitEventsTimeout(std::clamp(next, 0.001, kIdle_s));
    } else {
      glfwPollEvents();
    }
    const auto now = Clock::now();
    seconds = std::chrono::duration<double>(now - std::exchange(last, now)).count();
    advance(host.state, seconds);
    saver.advance(host.state, seconds);
  }

  /// Runs the script's next line once the results of the previous one are computed. Throws
  /// InputError if one of both fails.
  void continue_script() {
    if (!runs_script || host.busy()) return;
    const auto& log = host.state.messages.lines;
    const auto error = std::ranges::find(log, Severity::error, &LogLine::severity);
    if (error != log.end()) throw InputError(script_place + error->text);
    runs_script = !script.empty();
    if (!runs_script) return;
    script_place = fmt::format("{}:{}: ", script_file.string(), script.front().number);
    try {
      run_script_line(script.front().text);
    } catch (const InputError& refused) {
      throw InputError(script_place + refused.what());
    }
    script.pop_front();
    glfwPostEmptyEvent();
  }

  void run_script_line(const std::string& line) {
    const auto call = match_line(line);
    if (call && call->action->opens_device)
      throw InputError(call->action->name +
                       ": scripts open no cameras and streams; start with `view SOURCE`");
    run_line(host.state, line);
    saver.note_change();
  }

  void run() {
    int frames = 0, equal = 0;  // since the last event
    const std::stop_callback wake(current_stop(), [] { glfwPostEmptyEvent(); });
    while (!window.should_close() && !host.state.requests.quit &&
           !current_stop().stop_requested()) {
      // An event may open what Dear ImGui draws only some frames later, as a menu.
      if (input.waiting()) frames = equal = 0;
      const Commands commands = input.dispatch(host.state);
      for (const Command& command : commands) apply(host.state, command);
      if (!commands.empty()) {
        frames = equal = 0;
        saver.note_change();
      }
      host.synchronize();
      const bool other = std::exchange(opened, host.state.document.recording) != opened;
      if (other && !host.state.live) saver.note_change();
      for (std::string& line : own.log->take())
        host.state.messages.lines.push_back({Severity::note, std::move(line)});
      continue_script();
      update_title();
      window.set_fullscreen(host.state.view.fullscreen);
      const bool requested = draw();
      equal = requested || host.redrawn() ? 0 : equal + 1;
      const bool settled = equal >= kEqualFrames || ++frames >= kMaxFramesAfterEvent;
      // No event wakes the window after the last pending key.
      wait(settled && !input.waiting() && !host.state.requests.quit);
      if (settled) frames = equal = 0;
    }
  }
};

int open_window(const ViewArguments& arguments, OwnMethods& own, Interrupt& interrupt) {
  const InspectArguments& inspect = arguments.inspect;
  const auto path = inspect.recording.empty() ? std::nullopt : std::optional(inspect.recording);
  if (path && !fs::exists(*path))
    throw InputError(path->string() + ": no such file or folder; expected a recording");
  const bool shown = path && (is_session(*path) || is_results(*path));
  // Errors are reported before a window opens.
  if (path && !shown) resolve_recordings({*path});
  if (arguments.session) read_session(*arguments.session, own.table);
  const auto lines = arguments.script ? read_script(*arguments.script) : std::vector<ScriptLine>{};
  Session session(inspect, own);
  WorkbenchHost& host = session.host;
  session.script_file = arguments.script.value_or("");
  session.script.assign(lines.begin(), lines.end());
  session.runs_script = !lines.empty();
  host.link.remembers_files = true;
  host.link.calibrates = inspect.calibrate == "auto";
  host.state.files.asks = true;
  host.state.files.given = inspect.recording;
  host.state.files.given_topics = inspect.topics;
  host.state.files.recent = recent_files();
  host.state.files.has_last_session = fs::exists(last_session_file());
  const bool first_run = !host.state.files.has_last_session && host.state.files.recent.empty();
  if (first_run && session.script.empty() && !arguments.live) host.state.view.tour = 1;
  host.state.document.settings = inspect.settings;
  host.state.requests.open = arguments.session ? arguments.session : path;
  host.state.requests.live = arguments.live;
  const cv::Size kept = read_saved_window(host.state);
  const float scale = session.gui.scale();
  const cv::Size usual(cvRound(1280 * scale), cvRound(720 * scale));
  session.window.resize(kept.width > 0 ? kept : usual);
  if (!own.waiting.empty()) session.ask_for_commands();
  try {
    session.run();
  } catch (const Stopped&) {
    // While a drawing read a file.
  }
  const bool interrupted = current_stop().stop_requested();
  interrupt.end_soon(interrupted ? kFailed : kDone);
  const StopScope to_the_end(nullptr);
  save_last_session(host.state);
  save_window(session.window.place().size(), host.state);
  if (interrupted) throw Stopped{"the session was saved"};
  return kDone;
}

}  // namespace

RunCommand add_view(CLI::App& app) {
  const auto to = std::make_shared<ViewArguments>();
  CLI::App& command = *app.add_subcommand("view", "Opens the window (the default)");
  add_recording(command, to->inspect);
  command.add_option("--session", to->session, "Session to continue, a JSON file");
  command.add_option("--script",
                     to->script,
                     "File of commands to start with, one per line; an error ends the program");
  command.add_option(
      "--live", to->live, "Video or recording to play in real time, as if from a camera");
  return [to](OwnMethods& own, Interrupt& interrupt) {
    const std::string named = to->inspect.recording;
    if (to->live && (!named.empty() || to->session))
      throw InputError("--live: give no recording and no session besides it");
    if (is_live_address(named)) {
      to->live = named;
      to->inspect.recording.clear();
    }
    if (const auto session = to->session.value_or(to->inspect.recording); !session.empty())
      own.add_session(session);
    find_method(to->inspect, own.table);
    return open_window(*to, own, interrupt);
  };
}

}  // namespace gpo
