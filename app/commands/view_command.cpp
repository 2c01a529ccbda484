// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands/commands.h"
#include "app/recordings/recordings.h"
#include "engine/base/error.h"
#include "engine/experiment/results_file.h"
#include "engine/inspection/inspector.h"
#include "ui/context/gui.h"
#include "ui/context/window_context.h"
#include "ui/window_input.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/actions/apply.h"
#include "ui/workbench/playing.h"
#include "ui/workbench/session/recent_files.h"
#include "ui/workbench/session/script.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_host.h"
#include "ui/workbench_window.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <optional>
#include <utility>

#include <GLFW/glfw3.h>

namespace gpo {
namespace {

using Clock = std::chrono::steady_clock;

/// Dear ImGui needs a frame to see what the mouse hovers, and more to size what it opens: the
/// window has come to rest when so many frames are all alike. A text field's cursor never rests.
constexpr int kFramesAlike = 2;
constexpr int kMostFramesAfterEvent = 30;
constexpr double kIdle_s = 3600;
constexpr double kBetweenQuestions_s = 0.1;
constexpr const char* kTitle = "GPO Inspector";

/// Everything between opening the window and closing it.
struct Session {
  const ViewArguments& arguments;
  OwnMethods& own;
  std::string title = kTitle;
  WindowContext window{title, 1280, 720};
  WindowInput input{window.glfw()};
  Gui gui{window};
  WorkbenchHost host{gui,
                     opener_for_window(arguments.cache_mib, arguments.recording, arguments.topics),
                     example_recording(),
                     [] { glfwPostEmptyEvent(); }};
  std::deque<ScriptLine> script;
  Clock::time_point last = Clock::now();
  double seconds = 0;  ///< between the last two turns of the loop

  Session(const ViewArguments& from, OwnMethods& methods) : arguments(from), own(methods) {
    own.log->on_change([] { glfwPostEmptyEvent(); });
    host.state.methods = own.table;
    host.link.add_methods = [this](const std::filesystem::path& file, WorkbenchState& state) {
      own.add_session(file);
      if (!own.waiting.empty()) ask_for_commands();
      state.methods = own.table;
    };
  }
  ~Session() { own.log->on_change({}); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Whether the commands that only a session names may be started; before it is opened.
  void ask_for_commands() {
    constexpr std::size_t kAllOfIt = 4000;
    std::vector<std::string> shown;
    for (const std::string& one : own.waiting) shown.push_back(legible(one, kAllOfIt));
    const Question question{"This session starts commands of its own",
                            shown,
                            "They can do what you can. Start them if you know who wrote the "
                            "session; else their methods are listed and fail.",
                            "Start them",
                            "Do not start them"};
    std::optional<bool> answer;
    while (!answer && !window.should_close()) {
      const cv::Size size = window.size();
      window.bind();
      input.dispatch(host.state);
      if (size.width > 0 && size.height > 0) answer = ask(gui, size, question);
      window.swap();
      if (!answer) window.wait(kBetweenQuestions_s);
    }
    *own.allowed = answer.value_or(false);
    if (!*own.allowed) say_not_started(own);
  }

  void tell_what_methods_say() {
    for (std::string& line : own.log->take())
      host.state.messages.lines.push_back({Severity::note, std::move(line)});
  }

  /// Whether anything was done in it that the next frame is to show.
  bool draw() {
    host.size = window.size();
    if (host.size.width < 1 || host.size.height < 1) return false;  // minimized
    gui.set_screen_scale(window.content_scale());  // Wayland tells it once the window is shown
    window.bind();
    const Commands commands = host.draw(seconds);
    window.swap();
    for (const Command& command : commands) apply(host.state, command);
    return !commands.empty();
  }

  /// Tells the desktop, and who drives the window, what is open and whether it is being computed.
  void update_title() {
    const WorkbenchState& state = host.state;
    std::string now = state.document.recording ? state.document.recording->name + " \u2013 " : "";
    if (state.document.recording && state.document.recording->camera_source == CameraSource::guess)
      now += "the camera is a guess \u2013 ";
    if (host.link.worker.busy) now += "computing \u2013 ";
    now += kTitle;
    if (now == title) return;
    title = now;
    glfwSetWindowTitle(window.glfw(), title.c_str());
  }

  /// Sleeps until something happens or the next frame is due. Time goes on before the keys are
  /// heeded: what begins to play then has not slept.
  void wait(bool settled) {
    const auto due = seconds_to_next_frame(host.state);
    if ((due || settled) && !host.writing()) {
      const double message = seconds_of_message(host.state).value_or(kIdle_s);
      window.wait(std::clamp(std::min(due.value_or(kIdle_s), message), 0.001, kIdle_s));
    } else {
      window.poll();
    }
    const auto now = Clock::now();
    seconds = std::chrono::duration<double>(now - std::exchange(last, now)).count();
    advance(host.state, seconds);
  }

  /// What was done in the window, before the frame that shows it; whether there was anything.
  bool heed_input() {
    const Commands commands = input.dispatch(host.state);
    for (const Command& command : commands) apply(host.state, command);
    return !commands.empty();
  }

  /// One command at a time, each when what the last one asked for is computed.
  void go_on_with_script() {
    if (script.empty() || host.busy()) return;
    run_action(host.state, script.front().text);
    script.pop_front();
    glfwPostEmptyEvent();
  }

  void run() {
    int frames = 0, alike = 0;  // since something happened
    while (!window.should_close() && !host.state.requests.quit) {
      if (heed_input()) frames = alike = 0;
      host.synchronize();
      tell_what_methods_say();
      go_on_with_script();
      update_title();
      window.set_fullscreen(host.state.view.fullscreen);
      const bool asked = draw();
      alike = asked || host.redrawn() ? 0 : alike + 1;
      const bool settled = alike >= kFramesAlike || ++frames >= kMostFramesAfterEvent;
      // Nothing else would wake it after the last key.
      wait(settled && !input.waiting() && !host.state.requests.quit);
      if (settled) frames = alike = 0;
    }
  }
};

}  // namespace

int view_command(const ViewArguments& arguments, OwnMethods& own) {
  const auto& [recording, topics, cache_mib, calibrate, settings, given, session_file, script] =
      arguments;
  if (recording && !std::filesystem::exists(*recording)) {
    throw InputError(recording->string() + ": no such file or folder; expected a recording");
  }
  const bool shown = recording && (is_session(*recording) || is_results(*recording));
  if (recording && !shown) resolve_recordings({*recording});  // before a window would wait
  if (session_file)
    read_session(*session_file, own.table);  // an error is said before there is a window
  const auto lines = script ? read_script(*script) : std::vector<ScriptLine>{};
  Session session(arguments, own);
  session.script.assign(lines.begin(), lines.end());
  session.host.link.remembers_files = true;
  session.host.link.calibrates = calibrate == "auto";
  session.host.state.files.asks = true;
  session.host.state.files.recent = recent_files();
  session.host.state.files.has_last_session = std::filesystem::exists(last_session_file());
  session.host.state.document.settings = settings;
  session.host.state.requests.open = session_file ? session_file : recording;
  const SavedWindow kept = read_saved_window(session.host.state);
  const float scale = session.gui.scale();
  session.window.resize(kept.width > 0 ? cv::Size(kept.width, kept.height)
                                       : cv::Size(cvRound(1280 * scale), cvRound(720 * scale)));
  if (!own.waiting.empty()) session.ask_for_commands();
  session.run();
  save_last_session(session.host.state);
  const cv::Size size = session.window.place().size();
  save_window({size.width, size.height}, session.host.state);
  return kDone;
}

}  // namespace gpo
