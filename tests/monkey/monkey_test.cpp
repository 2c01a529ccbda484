// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/ui/gl_test.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench/state.h"
#include "ui/workbench_window.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>

#include <GL/glew.h>
#include <fmt/format.h>
#include <imgui.h>

namespace gpo {
namespace {

const std::filesystem::path kFolder = GPO_TEST_OUTPUT_DIR "/monkey";

int from_environment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

/// A random user, reproducible by the seed.
class Monkey {
 public:
  explicit Monkey(unsigned seed) : random_(seed) {}

  int below(int count) { return std::uniform_int_distribution<int>(0, count - 1)(random_); }
  double between(double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random_);
  }
  template <class Range>
  const auto& one_of(const Range& all) {
    return all[static_cast<std::size_t>(below(static_cast<int>(std::size(all))))];
  }

  /// Returns a line that opens, freezes or restarts a live source.
  std::string live_line() {
    static const std::vector<std::string> lines = {
        "live udp://127.0.0.1:5000", "live camera:63", "freeze", "compute", "live"};
    return one_of(lines);
  }

  /// Returns a line that writes a file into the current folder, or opens what an earlier one wrote.
  std::string file_line() {
    static const std::vector<std::string> lines = {"save-session s.json",
                                                   "open s.json",
                                                   "continue",
                                                   "open \"" GPO_SOURCE_DIR "/sequences/desk\"",
                                                   "open-example",
                                                   "save-recording written",
                                                   "open written",
                                                   "screenshot a.png",
                                                   "screenshot b.png scene 320x200",
                                                   "save-picture",
                                                   "export result r.json",
                                                   "export trajectory t.txt",
                                                   "export true-trajectory u.txt kitti",
                                                   "export points p.ply",
                                                   "export ply q.ply",
                                                   "export gltf g.glb",
                                                   "export foxglove f.mcap",
                                                   "export colmap model",
                                                   "export-video v.mp4"};
    return one_of(lines);
  }

  /// Returns an action's name with arguments that may or may not be valid. Each action has its turn
  /// before one comes again.
  std::string line() {
    if (turns_.empty()) {
      for (const Action& action : actions())
        if (action.name != "quit") turns_.push_back(&action);
      std::ranges::shuffle(turns_, random_);
    }
    const Action& action = *turns_.back();
    turns_.pop_back();
    std::string line = action.name;
    const int words = action.complete() ? below(2) : 1 + below(4);
    for (int i = 0; i < words && !action.arguments.empty(); ++i)
      line = fmt::format("{} {}", line, argument());
    return line;
  }

 private:
  std::string argument() {
    static const std::vector<std::string> words = split(
        "on,off,0,1,17,-3,1e9,nan,gpo,pba,ba,pnp_ba,x,\"a b\",frames,method,seed,exclude,none,"
        "default,gyro,averaging,ransac,consistent,gpo+no-ransac,all,20,40,0.5,\xff,robot,off,"
        "a.png,a.json,a.mp4,a.csv,scene,curves,320x200," GPO_SOURCE_DIR "/sequences/desk",
        ',');
    return below(3) == 0 ? fmt::format("{:.2f}", between(-100, 800)) : one_of(words);
  }

  std::mt19937 random_;
  std::vector<const Action*> turns_;
};

class MonkeyTest : public DrawingTest, public testing::WithParamInterface<int> {
 protected:
  /// A stream shows the example at five times its rate. A camera is missing.
  MonkeyTest() {
    host_.state.files.asks = true;
    host_.live.hooks.source = [](const std::string& address) {
      static const auto desk = open_recording(GPO_SOURCE_DIR "/sequences/desk");
      return address.starts_with("udp:") ? SourceAddress{"sequences/desk", desk}
                                         : SourceAddress{address};
    };
    LiveClock& clock = host_.live.hooks.clock;
    clock.now_ns = [now_ns = real_clock().now_ns] { return 5 * now_ns(); };
    clock.wait_until = [wait_until = real_clock().wait_until](std::int64_t time_ns,
                                                              const std::stop_token& stop) {
      wait_until(time_ns / 5, stop);
    };
  }

  void draw() {
    context_.bind();
    for (const Command& command : host_.draw()) apply(host_.state, command);
    ASSERT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }

  void use_mouse(Monkey& monkey) {
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(monkey.between(-10, host_.size.width + 10)),
                   static_cast<float>(monkey.between(-10, host_.size.height + 10))};
    for (int button = 0; button < 3; ++button)
      if (monkey.below(4) == 0) io.MouseDown[button] = !io.MouseDown[button];
    const bool shift = monkey.below(6) == 0;
    const bool alt = monkey.below(8) == 0;
    test::hold(monkey.below(6) == 0, shift, alt);
    if (monkey.below(5) == 0) io.MouseWheel = static_cast<float>(monkey.below(5) - 2);
    if (monkey.below(8) == 0) io.AddInputCharacter('a' + static_cast<unsigned>(monkey.below(26)));
  }

  OffscreenContext context_{1600, 900};
  Gui gui_;
  WorkbenchHost host_{
      gui_,
      [](const auto& path, const auto&...) { return Worker::with_inspector(open_recording(path)); },
      GPO_SOURCE_DIR "/sequences/desk"};
};

double resident_megabytes() {
  std::ifstream statm("/proc/self/statm");
  double size = 0, resident = 0;
  statm >> size >> resident;
  return resident * 4096 / 1e6;
}

/// GPO_MONKEY_TURNS sets the number of turns, GPO_MONKEY_SEED is added to the seeds.
TEST_P(MonkeyTest, SurvivesRandomInput) {
  if (!std::filesystem::exists(GPO_SOURCE_DIR "/sequences/desk"))
    GTEST_SKIP() << "no bundled recording";
  std::filesystem::create_directories(kFolder / "files");
  std::filesystem::current_path(kFolder / "files");  // the actions write files
  setenv("XDG_STATE_HOME", (kFolder / "state").c_str(), 1);
  const int turns = from_environment("GPO_MONKEY_TURNS", 150);
  const auto seed = static_cast<unsigned>(GetParam() + from_environment("GPO_MONKEY_SEED", 0));
  Monkey monkey(seed);
  SessionSaver saver;
  const std::vector<cv::Size> sizes = {
      {1280, 720}, {1024, 640}, {800, 500}, {1600, 900}, {640, 480}, {320, 200}};
  run_action(host_.state, "open-example");
  host_.settle();
  host_.draw();
  glGetError();  // VTK's first frame requests what the core profile lacks
  double settled_megabytes = 0;
  for (int turn = 0; turn < turns; ++turn) {
    std::string line;
    if (monkey.below(3) > 0) {
      const int kind = monkey.below(12);
      line = kind == 0 ? monkey.live_line() : kind == 1 ? monkey.file_line() : monkey.line();
      run_action(host_.state, line);
    }
    SCOPED_TRACE(fmt::format("seed {}, turn {}: {}", seed, turn, line));
    if (monkey.below(2) == 0) use_mouse(monkey);
    if (monkey.below(40) == 0) host_.size = monkey.one_of(sizes);
    if (monkey.below(25) == 0) host_.settle();
    host_.synchronize();
    draw();
    if (HasFatalFailure()) return;
    advance(host_.state, 0.02);
    saver.note_change();
    saver.advance(host_.state, 0.2);  // for `continue`
    ASSERT_GE(host_.state.view.frame, 0);
    ASSERT_LT(host_.state.view.frame, host_.state.frame_count());
    ASSERT_LE(host_.state.document.settings.start + host_.state.document.settings.frames,
              std::max(2, host_.state.frame_count()))
        << "only a live window may have a single frame";
    if (turn == turns / 2) settled_megabytes = resident_megabytes();
  }
  host_.settle();
  const double grown = resident_megabytes() - settled_megabytes;
  RecordProperty("grown_megabytes", std::to_string(grown));
  // The survey caches results, and VTK shaders; a leak in each turn would exceed this.
  EXPECT_LT(grown, 300);
}

/// Otherwise a command that is renamed would be left out in silence.
TEST(MonkeysLines, BeginWithCommands) {
  Monkey monkey(1);
  for (int i = 0; i < 300; ++i) {
    for (const std::string& line : {monkey.file_line(), monkey.live_line(), monkey.line()})
      EXPECT_TRUE(match_line(line)) << line;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, MonkeyTest, testing::Values(1, 2));

}  // namespace
}  // namespace gpo
