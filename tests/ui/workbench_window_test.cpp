// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/method_defaults.h"
#include "tests/ui/window_test.h"
#include "ui/context/opengl.h"
#include "ui/views/snapshot.h"

#include <algorithm>
#include <cstdlib>

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::find, test::first, test::line_of, testing::IsEmpty;

/// Frames 5 to 34 of 40.
const std::shared_ptr<const Inspection>& made() {
  static const auto inspection = test::shared_inspection();
  return inspection;
}

cv::Mat snapshot(const std::shared_ptr<const Inspection>& inspection,
                 int frame,
                 cv::Size size = {1280, 720}) {
  return snapshot_pane("window", inspection, frame, size);
}

class WorkbenchWindow : public test::WindowTest {};

class OpenedWindow : public WorkbenchWindow {
 protected:
  OpenedWindow() { open(*made()); }
};

TEST_F(WorkbenchWindow, DoesNothingByItself) {
  EXPECT_TRUE(draw().empty());
  open(*made());
  EXPECT_TRUE(draw().empty());
  state_.view.show_help = true;
  draw();
  EXPECT_TRUE(draw().empty());
}

TEST_F(OpenedWindow, RunsTheActionsOfTheTimeLinesButtons) {
  const float y = layout_.timeline.y + layout_.timeline.height / 2;
  float x = 27;
  for (const char* name : {"first", "previous", "play", "next", "last"}) {
    EXPECT_EQ(line_of(click(x, y)), name);
    x += 34;
  }
}

TEST_F(OpenedWindow, ScrubsOnTheTimeLine) {
  const float y = layout_.timeline.y + 30;
  point_at(400, y);
  const int at_press = first<GoToFrame>(press(true)).frame;
  EXPECT_GT(first<GoToFrame>(point_at(900, y)).frame, at_press);
  EXPECT_EQ(first<GoToFrame>(point_at(1279, y)).frame, state_.frame_count() - 1);
  press(false);
}

TEST_F(OpenedWindow, ZoomsTheImageByTheWheel) {
  const float x = layout_.image.x + 100, y = layout_.image.y + 300;
  const Commands zoomed = wheel(x, y);
  EXPECT_DOUBLE_EQ(first<ZoomImage>(zoomed).value.factor, 1.25);
  apply(state_, zoomed.front());
  press(true);
  const Commands still = point_at(x + 20, y);
  press(false);
  point_at(x, y);
  EXPECT_TRUE(still.empty()) << "the mouse did not move in the second frame";
}

TEST_F(OpenedWindow, OrbitsTheSceneByDragAndWheel) {
  const float x = layout_.side.x + 200, y = layout_.side.y + 300;
  const OrbitCamera nearer = first<OrbitScene>(wheel(x, y)).value.value();
  press(true);
  ImGui::GetIO().MousePos = {x + 50, y};
  const OrbitCamera turned = first<OrbitScene>(draw()).value.value();
  press(false);
  EXPECT_NE(turned.yaw_deg, nearer.yaw_deg);
  EXPECT_GT(turned.distance, nearer.distance);
}

TEST_F(OpenedWindow, SwitchesRansacInTheSettings) {
  const float y = layout().settings.y + 192;
  EXPECT_NE(uses_ransac(first<ChangeSettings>(click(115, y)).settings.options),
            uses_ransac(inspection_->settings.options));
}

TEST_F(OpenedWindow, SettingsStayUnderTheMouseIfTheVerdictGrows) {
  draw_times(2);
  const float before = layout().settings.y;
  point_at(layout().settings.x + 150, before + 100);
  auto longer = std::make_shared<Inspection>(*inspection_);
  auto result = std::make_shared<Initialization>(*inspection_->initialization);
  result->ok = false;
  for (int i = 0; i < 30; ++i) result->reason += "a reason of many words ";
  longer->initialization = result;
  state_.results.inspection = longer;
  draw_times(3);
  EXPECT_EQ(layout().settings.y, before);
  point_at(layout().image.x + 100, layout().image.y + 200);
  draw_times(2);
  EXPECT_GT(layout().settings.y, before) << "once the mouse is elsewhere";
}

/// A click on the number of the window's frames, as on any other, then digits and Enter.
TEST_F(OpenedWindow, TypesIntoANumberAfterOneClick) {
  const auto typed = [&](float y) {
    click(200, y);
    draw_times(3);
    if (!ImGui::GetIO().WantTextInput) return false;
    ImGui::GetIO().AddInputCharactersUTF8("17");
    draw();
    return true;
  };
  float y = layout_.settings.y + 40;
  while (y < layout_.settings.bottom() && !typed(y)) y += 8;
  ASSERT_LT(y, layout_.settings.bottom()) << "no number was edited";
  const Commands changes = click(400, 400);  // leaves the field
  const auto* change = find<ChangeSettings>(changes);
  ASSERT_NE(change, nullptr);
  EXPECT_TRUE(change->settings.start == 17 || change->settings.frames == 17);
}

TEST_F(WorkbenchWindow, OffersTheExampleWithoutARecording) {
  draw();
  const float x = (layout_.image.x + layout_.side.right()) / 2;
  bool offered = false;
  for (float y = 250; y < 450 && !offered; y += 10)
    offered = line_of(click(x, y)) == "open-example";
  EXPECT_TRUE(offered);
}

/// Dear ImGui aborts at a button without width. One of these widths leaves none to the time axis.
TEST_F(OpenedWindow, DrawsAtAnyWidth) {
  glGetError();  // VTK's first frame requests what the core profile lacks
  for (int width = 1; width < kWidth; width += width < 450 ? 1 : 100) draw({width, 720});
  for (int height = 1; height < 200; height += 3) draw({320, height});
  state_.view.toggles.scan = true;
  state_.results.scan = std::make_shared<const StartScan>();
  for (int width = 300; width < 450; ++width) draw({width, 720});
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST_F(OpenedWindow, DropsTheNumbersOfANarrowTimeLine) {
  for (const float x : {220.0F, 310.0F}) {  // the axis, the place of the numbers
    ImGui::GetIO().MousePos = {x, 660};
    for (int i = 0; i < 2; ++i) draw({380, 720});
    ImGui::GetIO().MouseDown[0] = true;
    EXPECT_NE(find<GoToFrame>(draw({380, 720})), nullptr) << x;
    ImGui::GetIO().MouseDown[0] = false;
    draw({380, 720});
  }
}

TEST_F(WorkbenchWindow, DrawsIncompleteResults) {
  for (const MadeOptions& options :
       {MadeOptions{.images = false}, MadeOptions{.ok = false}, MadeOptions{.truth = false}}) {
    open(made_inspection(options));
    for (const int frame : {0, 15, 39}) {
      apply(state_, GoToFrame{frame});
      draw();
    }
  }
  state_.results.inspection.reset();
  worker_ = {true, "tracking", 12, 30, ""};
  draw();
  worker_ = {false, "", 0, 0, std::string(300, 'x')};
  draw();
}

TEST_F(OpenedWindow, SavesTheImageAtTheRecordingsSize) {
  const cv::Mat image = view("picture");
  const Camera& camera = inspection_->recording->camera;
  EXPECT_EQ(image.size(), cv::Size(camera.width, camera.height));
  state_.view.toggles = {false, false, false, false, false};
  EXPECT_FALSE(compare_images(image, view("picture")).equal);
}

class UnchangedWindow : public OpenedWindow {
 protected:
  UnchangedWindow() { draw_times(2); }  // sizes settle
  bool redrawn(const Rectangle& place) const {
    const cv::Point middle(static_cast<int>(place.x + place.width / 2),
                           static_cast<int>(place.y + place.height / 2));
    return std::ranges::any_of(views_->window.redrawn(),
                               [&](const cv::Rect& part) { return part.contains(middle); });
  }
};

TEST_F(UnchangedWindow, IsNotDrawnAgain) {
  const std::size_t renders = views_->scene.renders();
  draw();
  EXPECT_THAT(views_->window.redrawn(), IsEmpty());
  EXPECT_EQ(views_->scene.renders(), renders);
}

TEST_F(UnchangedWindow, DrawsOnlyTheViewsAfterAStep) {
  const std::size_t renders = views_->scene.renders();
  for (const int frame : {20, 21}) {
    apply(state_, GoToFrame{frame});
    draw();
    EXPECT_TRUE(redrawn(layout_.image));
    EXPECT_TRUE(redrawn(layout_.side));
    EXPECT_FALSE(redrawn(layout_.settings));
    const cv::Mat cached = context_.read_bgr();
    views_->window = WindowImage();  // draws everything
    draw();
    EXPECT_TRUE(same_bytes(cached, context_.read_bgr()));
  }
  EXPECT_EQ(views_->scene.renders(), renders);
}

TEST_F(UnchangedWindow, DrawsTheImageWhenTracksAreHidden) {
  state_.view.toggles.tracks = !state_.view.toggles.tracks;
  draw();
  EXPECT_TRUE(redrawn(layout_.image));
  EXPECT_FALSE(redrawn(layout_.side));
}

struct Screen {
  cv::Size size;
  float scale;
};

class EveryPane : public DrawingTest, public testing::WithParamInterface<Screen> {};

TEST_P(EveryPane, DiffersFromTheOthers) {
  const cv::Size size = GetParam().size;
  OffscreenContext context(size.width, size.height);
  Gui gui(GetParam().scale);
  Views views;
  const auto drawn = [&](const WorkbenchState& state) {
    context.bind();
    for (int i = 0; i < 3; ++i)
      draw_workbench({.state = state, .timings = false}, size, gui, views);
    return context.read_bgr();
  };
  for (const MadeOptions& options :
       {MadeOptions{.normal_sigma_deg = 0.3}, MadeOptions{.ok = false}}) {
    const auto inspection = test::shared_inspection(options);
    WorkbenchState state;
    test::open(state, inspection);
    run_line(state, "select track " + std::to_string(inspection->tracks->ids[3]));
    std::vector<cv::Mat> images = {drawn(state)};
    for (const Action& action : actions()) {
      if (!action.name.starts_with("view ") || !action.complete()) continue;
      if (action.name == "view scene" || action.name == "view no-drawer") continue;
      WorkbenchState other = state;
      run_line(other, action.name);
      images.push_back(drawn(other));
      const auto same = [&](const cv::Mat& one) { return same_bytes(one, images.back()); };
      EXPECT_EQ(std::ranges::count_if(images, same), 1) << action.name;
    }
    for (const char* line : {"help", "palette", "theme light"}) {
      WorkbenchState other = state;
      run_line(other, line);
      EXPECT_FALSE(same_bytes(drawn(other), images.front())) << line;
    }
    EXPECT_TRUE(same_bytes(drawn(state), images.front())) << "back in the dark theme";
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes,
                         EveryPane,
                         testing::Values(Screen{{1024, 640}, 1},
                                         Screen{{1280, 720}, 1},
                                         Screen{{2560, 1440}, 2},
                                         Screen{{3840, 2160}, 2}),
                         [](const auto& info) {
                           return std::to_string(info.param.size.width) + "at" +
                                  std::to_string(static_cast<int>(info.param.scale));
                         });

TEST(WindowSnapshot, DoesNotDependOnTimes) {
  Inspection other = *made();
  const cv::Mat first = snapshot(made(), 29);
  EXPECT_EQ(first.size(), cv::Size(1280, 720));
  other.timing = {1, 22, 333, 4444, 5, 6};
  EXPECT_TRUE(same_bytes(first, snapshot(std::make_shared<const Inspection>(other), 29)));
  EXPECT_FALSE(same_bytes(first, snapshot(made(), 10)));
}

TEST(WindowSnapshot, ShowsVerdictsAtAnySize) {
  const auto judged = test::shared_inspection({.estimate_error = 0.5, .normal_sigma_deg = 0.31});
  EXPECT_EQ(snapshot(judged, 29, {64, 48}).size(), cv::Size(64, 48));
  for (const cv::Size size : {cv::Size(1024, 640), cv::Size(1280, 720), cv::Size(1920, 1080)}) {
    const cv::Mat image = snapshot(judged, 29, size);
    EXPECT_EQ(image.size(), size);
    EXPECT_FALSE(same_bytes(image, snapshot(made(), 29, size)));
    keep("window_" + std::to_string(size.width), image);
  }
}

/// Needs a display; the next test runs it.
TEST(RealWindow, DISABLED_EqualsTheSnapshotOnThisDisplay) {
  const cv::Size size(1280, 720);
  cv::Mat on_screen;
  {
    WindowContext window("test", size.width, size.height);
    ASSERT_EQ(window.size(), size);
    Gui gui(window);
    Views views;
    WorkbenchState state;
    test::open(state, made());
    state.messages.text.clear();
    glfwSetCursorPos(glfwGetCurrentContext(), 700, 710);  // over nothing with a tooltip
    for (int i = 0; i < 3; ++i) {
      glfwPollEvents();
      window.bind();
      draw_workbench({.state = state, .timings = false}, size, gui, views);
      if (i == 2) on_screen = window.read_bgr();
      window.swap();
    }
  }
  const auto comparison = compare_images(on_screen, snapshot(made(), 34, size));
  EXPECT_TRUE(comparison.equal) << comparison.reason;
  if (comparison.equal) return;
  keep("real-window", on_screen);
  keep("real-window.diff", comparison.difference);
}

TEST(RealWindow, EqualsTheSnapshotUnderXvfb) {
  if (std::system("command -v Xvfb > /dev/null") != 0) GTEST_SKIP() << "Xvfb is not installed";
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  const std::string command = "'" GPO_SOURCE_DIR "/tests/with_display.sh' 1280x1024 '" + self +
                              "' --gtest_also_run_disabled_tests --gtest_brief=1"
                              " --gtest_filter=RealWindow.DISABLED_EqualsTheSnapshotOnThisDisplay";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST_F(WorkbenchWindow, LegendOfTheTimeLineFitsANarrowWindow) {
  Inspection inspection = made_inspection();
  inspection.metric_scale_from = 3;
  inspection.motion.assign(inspection.window->frame_count(), {103, 26});
  for (const int width : {900, 1100, 1280}) {
    open(inspection);
    draw({width, kHeight});
    float end = 0;
    const ImDrawData& drawn = *ImGui::GetDrawData();
    for (int i = 0; i < drawn.CmdListsCount; ++i) {
      const ImDrawList& list = *drawn.CmdLists[i];
      if (!std::string_view(list._OwnerName).starts_with("timeline")) continue;
      for (const ImDrawVert& vertex : list.VtxBuffer) end = std::max(end, vertex.pos.x);
    }
    EXPECT_GT(end, 0);
    EXPECT_LE(end, static_cast<float>(width)) << width;
  }
}

}  // namespace
}  // namespace gpo
