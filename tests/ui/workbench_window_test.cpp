// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench_window.h"

#include "engine/pipeline/method_defaults.h"
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/window_context.h"
#include "ui/panels/timeline/time_axis.h"
#include "ui/views/snapshot.h"
#include "ui/workbench/actions/apply.h"
#include "ui/workbench/work/apply_recording.h"

#include <cstdlib>
#include <filesystem>
#include <memory>

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <imgui.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

std::shared_ptr<const Inspection> made(const MadeOptions& options) {
  return std::make_shared<const Inspection>(made_inspection(options));
}

/// Frames 5 to 34 of 40; made once.
const std::shared_ptr<const Inspection>& made() {
  static const auto inspection = made(MadeOptions{});
  return inspection;
}

/// The window off-screen, with a mouse that the test moves.
class WorkbenchWindow : public DrawingTest {
 protected:
  static constexpr int kWidth = 1280, kHeight = 720;

  Commands draw(cv::Size size = {kWidth, kHeight}) {
    context_.bind();
    return draw_workbench({state_, idle_, no_survey_, true, gui_.scale()}, size, gui_, *views_);
  }

  void open(std::shared_ptr<const Inspection> inspection = made()) {
    inspection_ = std::move(inspection);
    state_.document.settings = inspection_->settings;
    apply_recording(state_, inspection_->recording);
    state_.results.inspection = inspection_;
    draw();
  }

  /// Dear ImGui sees what the mouse hovers in one frame, and acts on it in the next.
  Commands point_at(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    draw();
    return draw();
  }
  Commands press(bool down) {
    ImGui::GetIO().MouseDown[0] = down;
    return draw();
  }
  Commands click(float x, float y) {
    point_at(x, y);
    Commands all = press(true);
    for (const Command& command : press(false)) push(all, command);
    return all;
  }

  template <class C>
  static const C* find(const Commands& commands) {
    for (const Command& command : commands) {
      if (const C* found = std::get_if<C>(&command)) return found;
    }
    return nullptr;
  }

  OffscreenContext context_{kWidth, kHeight};
  Gui gui_;
  std::unique_ptr<Views> views_ = std::make_unique<Views>();
  WorkbenchState state_;
  JobStatus idle_;
  SurveyStatus no_survey_;
  std::shared_ptr<const Inspection> inspection_;
  WindowLayout layout_ = window_layout(kWidth, kHeight, 1, {}, false);
};

TEST_F(WorkbenchWindow, DoesNothingByItself) {
  EXPECT_TRUE(draw().empty());
  open();
  EXPECT_TRUE(draw().empty());
  state_.view.show_help = true;
  draw();
  EXPECT_TRUE(draw().empty());
}

TEST_F(WorkbenchWindow, ButtonsOfTheTimeLineRunTheirActions) {
  open();
  const float y = layout_.timeline.y + layout_.timeline.height / 2;
  float x = 27;
  for (const char* name : {"first", "previous", "play", "next", "last"}) {
    const Commands commands = click(x, y);
    const auto* action = find<RunAction>(commands);
    ASSERT_NE(action, nullptr) << name;
    EXPECT_EQ(action->line, name);
    x += 34;
  }
}

TEST_F(WorkbenchWindow, DraggingOnTheTimeLineScrubs) {
  open();
  const float y = layout_.timeline.y + 30;
  point_at(400, y);
  const Commands at_press = press(true);
  ASSERT_NE(find<GoToFrame>(at_press), nullptr);
  const int first = find<GoToFrame>(at_press)->frame;
  const Commands at_drag = point_at(900, y);
  ASSERT_NE(find<GoToFrame>(at_drag), nullptr);
  EXPECT_GT(find<GoToFrame>(at_drag)->frame, first);
  // Beyond its end it is the last frame.
  const Commands beyond = point_at(1279, y);
  EXPECT_EQ(find<GoToFrame>(beyond)->frame, state_.frame_count() - 1);
  press(false);
}

TEST_F(WorkbenchWindow, WheelZoomsTheImageAndDragMovesIt) {
  open();
  const float x = layout_.image.x + 100, y = layout_.image.y + 300;
  point_at(x, y);
  ImGui::GetIO().MouseWheel = 1;
  const Commands zoomed = draw();
  ASSERT_NE(find<ZoomImage>(zoomed), nullptr);
  EXPECT_DOUBLE_EQ(find<ZoomImage>(zoomed)->zoom.factor, 1.25);
  apply(state_, zoomed.front());
  press(true);
  const Commands moved = point_at(x + 20, y);
  press(false);
  point_at(x, y);
  EXPECT_TRUE(moved.empty());  // the second frame at a place has no movement
}

TEST_F(WorkbenchWindow, WheelAndDragMoveTheCameraOfTheScene) {
  open();
  const float x = layout_.side.x + 200, y = layout_.side.y + 300;
  point_at(x, y);
  ImGui::GetIO().MouseWheel = 1;
  const Commands nearer = draw();
  ASSERT_NE(find<OrbitScene>(nearer), nullptr);
  press(true);
  ImGui::GetIO().MousePos = {x + 50, y};
  const Commands turned = draw();
  press(false);
  ASSERT_NE(find<OrbitScene>(turned), nullptr);
  EXPECT_NE(find<OrbitScene>(turned)->camera.yaw_deg, find<OrbitScene>(nearer)->camera.yaw_deg);
  EXPECT_GT(find<OrbitScene>(turned)->camera.distance, find<OrbitScene>(nearer)->camera.distance);
}

TEST_F(WorkbenchWindow, RansacIsSwitchedInTheSettings) {
  open();
  const Commands commands = click(115, 218);
  ASSERT_NE(find<ChangeSettings>(commands), nullptr);
  EXPECT_NE(uses_ransac(find<ChangeSettings>(commands)->settings.options),
            uses_ransac(inspection_->settings.options));
}

TEST_F(WorkbenchWindow, EmptyWindowOffersTheExample) {
  draw();
  const float x = (layout_.image.x + layout_.side.right()) / 2;
  bool offered = false;
  for (float y = 250; y < 450 && !offered; y += 10) {
    const Commands commands = click(x, y);
    offered = find<RunAction>(commands) && find<RunAction>(commands)->line == "open-example";
  }
  EXPECT_TRUE(offered);
}

TEST_F(WorkbenchWindow, ClickBesideTheKeysClosesThem) {
  open();
  state_.view.show_help = true;
  draw();
  const Commands commands = click(20, 400);
  ASSERT_NE(find<RunAction>(commands), nullptr);
  EXPECT_EQ(find<RunAction>(commands)->line, "escape");
}

/// Dear ImGui ends the program at a button of no width. Among these widths is the one at which
/// nothing is left of the time axis, with its buttons and numbers as they are.
TEST_F(WorkbenchWindow, DrawsInAnyWidth) {
  open();
  glGetError();  // VTK's first frame asks OpenGL for what the core profile has not
  for (int width = 1; width < kWidth; width += width < 450 ? 1 : 100) draw({width, 720});
  for (int height = 1; height < 200; height += 3) draw({320, height});
  state_.view.toggles.scan = true;
  state_.results.scan = std::make_shared<const StartScan>();
  for (int width = 300; width < 450; ++width) draw({width, 720});
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(WorkbenchWindow, NarrowTimeLineLeavesOutItsNumbersForTheAxis) {
  open();
  const auto goes_to_a_frame = [&](float x) {
    ImGui::GetIO().MousePos = {x, 660};
    draw({380, 720});
    draw({380, 720});
    ImGui::GetIO().MouseDown[0] = true;
    const Commands pressed = draw({380, 720});
    ImGui::GetIO().MouseDown[0] = false;
    draw({380, 720});
    return find<GoToFrame>(pressed) != nullptr;
  };
  EXPECT_TRUE(goes_to_a_frame(220));
  EXPECT_TRUE(goes_to_a_frame(310));  // where the numbers would be
}

TEST_F(WorkbenchWindow, DrawsWhateverIsKnown) {
  for (const MadeOptions& options :
       {MadeOptions{.images = false}, MadeOptions{.ok = false}, MadeOptions{.truth = false}}) {
    open(made(options));
    for (const int frame : {0, 15, 39}) {
      apply(state_, GoToFrame{frame});
      draw();
    }
  }
  state_.results.inspection.reset();  // opened, but nothing is computed yet
  idle_ = {true, "tracking", 12, 30, ""};
  draw();
  idle_ = {false, "", 0, 0, std::string(300, 'x')};
  draw();
}

TEST_F(WorkbenchWindow, ImageToDiskIsAsLargeAsTheRecordings) {
  open();
  const auto draw_image = [&] {
    return draw_view("picture", {}, {state_, idle_, no_survey_}, {}, gui_, *views_);
  };
  const cv::Mat image = draw_image();
  EXPECT_EQ(image.cols, inspection_->recording->camera.width);
  EXPECT_EQ(image.rows, inspection_->recording->camera.height);
  state_.view.toggles = {false, false, false, false, false};
  const cv::Mat plain = draw_image();
  EXPECT_FALSE(compare_images(image, plain).equal);
}

TEST(WindowSnapshot, HasTheSameBytesWhateverTheComputationTook) {
  Inspection other = *made();
  const cv::Mat first = snapshot_window(made(), 29);
  EXPECT_EQ(first.size(), cv::Size(1280, 720));
  other.timing = {1, 22, 333, 4444, 5, 6};
  const cv::Mat second = snapshot_window(std::make_shared<const Inspection>(other), 29);
  EXPECT_TRUE(same_bytes(first, second));
  EXPECT_FALSE(same_bytes(first, snapshot_window(made(), 10)));
}

TEST(WindowSnapshot, IsDrawnAtAnySize) {
  for (const cv::Size size : {cv::Size(800, 500), cv::Size(64, 48)}) {
    EXPECT_EQ(snapshot_window(made(), 29, size).size(), size);
  }
}

TEST(WindowSnapshot, ShowsVerdictsAtAnySize) {
  const auto judged = made({.estimate_error = 0.5, .normal_sigma_deg = 0.31});
  for (const cv::Size size : {cv::Size(1024, 640), cv::Size(1280, 720), cv::Size(1920, 1080)}) {
    const cv::Mat image = snapshot_window(judged, 29, size);
    EXPECT_FALSE(same_bytes(image, snapshot_window(made(), 29, size)));
    const std::filesystem::path folder = GPO_TEST_OUTPUT_DIR;
    std::filesystem::create_directories(folder);
    cv::imwrite((folder / ("window_" + std::to_string(size.width) + ".png")).string(), image);
  }
}

/// Draws in a real window; in a process that has a display.
TEST(RealWindow, DISABLED_EqualsTheSnapshotOnThisDisplay) {
  const auto& inspection = made();
  const cv::Size size(1280, 720);
  cv::Mat on_screen;
  {
    WindowContext window("test", size.width, size.height);
    ASSERT_EQ(window.size(), size);
    Gui gui(window);
    Views views;
    WorkbenchState state;
    state.document.settings = inspection->settings;
    apply_recording(state, inspection->recording);
    state.results.inspection = inspection;
    state.messages.text.clear();
    const JobStatus idle;
    const SurveyStatus no_survey;
    glfwSetCursorPos(glfwGetCurrentContext(), 700, 710);  // where nothing tells of itself
    for (int i = 0; i < 3; ++i) {
      window.poll();
      window.bind();
      draw_workbench({state, idle, no_survey, false, gui.scale()}, size, gui, views);
      if (i == 2) on_screen = window.read_bgr();
      window.swap();
    }
  }
  const auto comparison = compare_images(on_screen, snapshot_window(inspection, 34, size));
  EXPECT_TRUE(comparison.equal) << comparison.reason;
  if (comparison.equal) return;
  const std::filesystem::path folder = GPO_TEST_OUTPUT_DIR;
  std::filesystem::create_directories(folder);
  cv::imwrite((folder / "real-window.png").string(), on_screen);
  cv::imwrite((folder / "real-window.diff.png").string(), comparison.difference);
}

TEST(RealWindow, UnderXvfbEqualsTheImageDrawnOffScreen) {
  if (std::system("command -v Xvfb > /dev/null") != 0) GTEST_SKIP() << "Xvfb is not installed";
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = "'" GPO_SOURCE_DIR "/tests/with_display.sh' 1280x1024 '" + self +
                              "' --gtest_also_run_disabled_tests --gtest_brief=1"
                              " --gtest_filter=RealWindow.DISABLED_EqualsTheSnapshotOnThisDisplay";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

}  // namespace
}  // namespace gpo
