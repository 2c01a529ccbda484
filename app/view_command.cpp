// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.h"
#include "app/recordings.h"
#include "engine/error.h"
#include "engine/initializers/methods.h"
#include "engine/inspection/worker.h"
#include "ui/context/gui.h"
#include "ui/context/window_context.h"
#include "ui/window_input.h"
#include "ui/workbench/worker_link.h"
#include "ui/workbench_window.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

using Clock = std::chrono::steady_clock;

/// Dear ImGui needs a frame to see what the mouse hovers, and another one to size what it opens.
constexpr int kFramesAfterEvent = 3;
constexpr double kIdle_s = 3600;
constexpr const char* kTitle = "GPO Inspector";

/// The recording that comes with the program: beside the sources it was built from, else beside the
/// executable or where it is run.
std::filesystem::path example_recording() {
  std::error_code none;
  const auto executable = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
  std::filesystem::path example = std::filesystem::path("sequences") / "desk";
  for (const auto& root : {std::filesystem::path(GPO_SOURCE_DIR),
                           executable,
                           executable.parent_path(),
                           std::filesystem::current_path(none)}) {
    if (std::filesystem::exists(root / example, none)) return root / example;
  }
  return example;
}

/// "desk-0029.png", or with a number where that is taken.
std::filesystem::path free_picture_name(const std::string& recording, int frame) {
  std::filesystem::path name = fmt::format("{}-{:04}.png", recording, frame);
  for (int i = 2; std::filesystem::exists(name); ++i) {
    name = fmt::format("{}-{:04}-{}.png", recording, frame, i);
  }
  return name;
}

void save_picture(WorkbenchState& state, const cv::Mat& picture) {
  const auto name = free_picture_name(state.recording->name, state.frame);
  bool written = false;
  try {
    written = cv::imwrite(name.string(), picture);
  } catch (const cv::Exception&) {
  }
  state.message = written ? "saved " + name.string()
                          : "cannot write " + std::filesystem::absolute(name).string();
}

/// Everything between opening the window and closing it.
struct Session {
  std::string title = kTitle;
  WindowContext window{title, 1280, 720};
  WindowInput input{window.glfw()};
  Gui gui{window};
  Views views;
  WorkbenchState state;
  WorkerLink link;
  std::filesystem::path example = example_recording();
  Worker worker{Worker::open_with_inspector, [] { glfwPostEmptyEvent(); }};
  Clock::time_point last = Clock::now();
  double seconds = 0;  ///< between the last two turns of the loop

  PanelInput panel_input() const {
    return {state, link.inspection.get(), link.status, true, gui.scale()};
  }

  void draw() {
    const cv::Size size = window.size();
    if (size.width < 1 || size.height < 1) return;  // minimized
    window.bind();
    const Commands commands = draw_workbench(panel_input(), size, gui, views, seconds);
    window.swap();
    for (const Command& command : commands) apply(state, command);
  }

  /// Tells the desktop, and who drives the window, what is open and whether it is being computed.
  void update_title() {
    std::string now = state.recording ? state.recording->name + " \u2013 " : "";
    if (link.status.busy) now += "computing \u2013 ";
    now += kTitle;
    if (now == title) return;
    title = now;
    glfwSetWindowTitle(window.glfw(), title.c_str());
  }

  /// Sleeps until something happens or the next frame is due. Time goes on before the keys are
  /// heeded: what begins to play now has not slept.
  void wait(bool settled) {
    const auto due = seconds_to_next_frame(state);
    if (due || settled) {
      window.wait(std::max(0.001, due.value_or(kIdle_s)));
    } else {
      window.poll();
    }
    const auto now = Clock::now();
    seconds = std::chrono::duration<double>(now - std::exchange(last, now)).count();
    advance(state, seconds);
    for (const Command& command : input.take()) apply(state, command);
  }

  void run() {
    for (int frames = kFramesAfterEvent; !window.should_close() && !state.wishes.quit;) {
      synchronize(state, link, worker, example);
      update_title();
      if (std::exchange(state.wishes.save_picture, false)) {
        save_picture(state, draw_picture(panel_input(), gui, views));
      }
      draw();
      --frames;
      wait(frames <= 0);
      if (frames <= 0) frames = kFramesAfterEvent;
    }
  }
};

}  // namespace

int view_command(const std::optional<std::filesystem::path>& recording, const Settings& settings) {
  find_method(settings.method);
  if (recording && !std::filesystem::exists(*recording)) {
    throw InputError(recording->string() + ": no such file or folder; expected a recording");
  }
  std::vector<std::filesystem::path> given;
  if (recording) given.push_back(*recording);
  const auto folder = resolve_recordings(given);  // before there is a window that would wait
  Session session;
  session.state.settings = settings;
  if (recording) session.state.wishes.open = folder.front();
  const float scale = session.gui.scale();
  if (scale > 1) {
    glfwSetWindowSize(
        session.window.glfw(), static_cast<int>(1280 * scale), static_cast<int>(720 * scale));
  }
  session.run();
  return kDone;
}

}  // namespace gpo
