// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The window with large text, and texts that do not fit.
#include "tests/engine/test_folder.h"
#include "tests/ui/window_test.h"
#include "ui/context/imgui_versions.h"

#include <algorithm>
#include <set>
#include <thread>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::Contains;

/// Returns the first shown window of Dear ImGui with a flag; null if there is none.
const ImGuiWindow* shown_window(ImGuiWindowFlags flag) {
  for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows)
    if (window->Active && !window->Hidden && (window->Flags & flag) != 0) return window;
  return nullptr;
}

const ImGuiWindow* open_list() {
  return ImGui::GetCurrentContext()->OpenPopupStack.empty() ? nullptr
                                                            : shown_window(ImGuiWindowFlags_Popup);
}

class LargeText : public test::WindowTest {
 protected:
  LargeText() {
    open(made_inspection());
    gui_.set_zoom(2);
    draw_times(3);
  }
  const WindowLayout large_ = window_layout({.width = kWidth, .height = kHeight, .scale = 2});
};

TEST_F(LargeText, ReachesEveryPaneByTabsOrTheirList) {
  const Rectangle& tabs = large_.side_tabs;
  const float y = tabs.y + tabs.height / 2;
  std::set<std::string> reached;
  float list_x = 0;
  for (float x = tabs.x + 20; x < tabs.right(); x += 20) {
    reached.insert(test::line_of(click(x, y)));
    draw();
    if (open_list() == nullptr) continue;
    list_x = x;
    break;
  }
  ASSERT_GT(list_x, 0) << "no list of the other panes opens";
  const ImRect list(
      open_list()->Pos,
      {open_list()->Pos.x + open_list()->Size.x, open_list()->Pos.y + open_list()->Size.y});
  for (float at = list.Min.y + 8; at < list.Max.y; at += 16) {
    if (open_list() == nullptr) click(list_x, y);
    reached.insert(test::line_of(click(list.GetCenter().x, at)));
    draw();
  }
  for (const Pane& pane : side_panes())
    EXPECT_THAT(reached, Contains(std::string("view ") + pane.key));
}

TEST_F(LargeText, HelpIsNotWiderThanItsWindow) {
  state_.view.show_help = true;
  for (const HelpPage page :
       {HelpPage::keys, HelpPage::glossary, HelpPage::manual, HelpPage::findings, HelpPage::about}) {
    state_.view.help_page = page;
    draw_times(4);
    const ImGuiWindow* help = ImGui::FindWindowByName("keys");
    ASSERT_NE(help, nullptr);
    EXPECT_LE(help->ContentSize.x, help->WorkRect.GetWidth() + 1);
    EXPECT_LE(help->Pos.x + help->Size.x, static_cast<float>(kWidth));
  }
}

TEST_F(LargeText, MarksGrowWithTheSquareRoot) {
  const auto width_of_circle = [&] {
    gui_.begin_frame(kWidth, kHeight);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const int first = list.VtxBuffer.Size;
    draw_sign(list, Sign::circle, {100, 100}, 0xFFFFFF);
    float right = 100;
    for (int i = first; i < list.VtxBuffer.Size; ++i)
      right = std::max(right, list.VtxBuffer[i].pos.x);
    gui_.end_frame();
    return right - 100;
  };
  context_.bind();
  const float large = width_of_circle();
  gui_.set_zoom(1);
  EXPECT_NEAR(large / width_of_circle(), std::sqrt(2.0), 0.2);
}

TEST_F(LargeText, MapPointsCoverTwiceTheAreaAtTwiceTheSize) {
  state_.view.viewpoint = Viewpoint::top;
  const auto points = [&] {
    return count_pixels(view("scene", cv::Size(900, 700)), color_of(Role::map_point));
  };
  const int large = points();
  gui_.set_zoom(1);
  const int small = points();
  ASSERT_GT(small, 100);
  EXPECT_LT(large, 3 * small);
}

class Texts : public test::WindowTest {
 protected:
  Texts() { open(made_inspection()); }
  cv::Mat image() {
    draw_times(2);
    return context_.read_bgr();
  }
};

TEST_F(Texts, TooltipOfATabVanishesAtAClickAndReturnsWithTheMouse) {
  const float x = layout_.side_tabs.x + 20;
  const float y = layout_.side_tabs.y + layout_.side_tabs.height / 2;
  point_at(x, y);
  draw_times(2);
  EXPECT_NE(shown_window(ImGuiWindowFlags_Tooltip), nullptr);
  click(x, y);
  draw_times(2);
  EXPECT_EQ(shown_window(ImGuiWindowFlags_Tooltip), nullptr);
  point_at(layout_.image.x + 5, layout_.image.y + 5);
  point_at(x, y);
  draw_times(2);
  EXPECT_NE(shown_window(ImGuiWindowFlags_Tooltip), nullptr);
}

TEST_F(Texts, LinesOfTheLogAreWrapped) {
  run_line(state_, "view log");
  std::string line;
  for (int i = 0; i < 60; ++i) line += "words ";
  state_.messages.lines = {{Severity::note, line}};
  const cv::Mat without = image();
  state_.messages.lines.front().text += "end";
  EXPECT_FALSE(same_bytes(without, image())) << "its end is cut off";
}

TEST_F(Texts, ListsOfChoicesShowAllRows) {
  int lists = 0;
  for (float y = layout_.settings.y + 20; y < layout_.settings.bottom(); y += 12) {
    click(layout_.settings.right() - 60, y);
    draw_times(2);
    const ImGuiWindow* list = open_list();
    if (list == nullptr) continue;
    ++lists;
    EXPECT_EQ(list->ScrollMax.y, 0) << "at " << y;
    close_popups();
    draw();
  }
  EXPECT_GT(lists, 1);
}

TEST_F(Texts, SayThatResultsAreOfTheOldRecordingWhileAnotherIsRendered) {
  PanelInput shown = input();
  shown.worker = {.busy = true, .stage = "rendering", .done = 3, .of = 60};
  const auto drawn = [&] {
    for (int i = 0; i < 2; ++i) {
      context_.bind();
      draw_workbench(shown, {kWidth, kHeight}, gui_, *views_);
    }
    return context_.read_bgr();
  };
  const cv::Mat computing = drawn();
  shown.opening = true;
  EXPECT_FALSE(same_bytes(computing, drawn()));
}

TEST_F(Texts, NameOfTheRecordingIsShownInAnyScript) {
  Inspection inspection = made_inspection();
  auto recording = std::make_shared<Recording>(*inspection.recording);
  recording->name = "\u4F60\u597D";
  inspection.recording = recording;
  open(inspection);
  draw();
  EXPECT_NE(font(Font::regular)->FindGlyphNoFallback(0x4F60), nullptr);
}

TEST_F(Texts, ErrorsAgainstGroundTruthNeedNoScrolling) {
  Inspection inspection = made_inspection({.normal_sigma_deg = 0.3});
  inspection.evaluation->scale_error_percent = 1;
  open(inspection);
  const cv::Rect column(0, 0, static_cast<int>(layout_.results.right()), kHeight);
  const cv::Mat before = image()(column).clone();
  for (const auto error : {&Evaluation::pne_deg,
                           &Evaluation::pde_m,
                           &Evaluation::ate_m,
                           &Evaluation::scale_error_percent}) {
    Inspection other = inspection;
    *other.evaluation.*error = 7.7;
    state_.results.inspection = std::make_shared<const Inspection>(other);
    EXPECT_FALSE(same_bytes(before, image()(column).clone()));
  }
}

void hold_enter(bool down) {
  ImGuiIO& io = ImGui::GetIO();
#if IMGUI_VERSION_NUM < 18700
  io.KeyMap[ImGuiKey_Enter] = GLFW_KEY_ENTER;
  io.KeysDown[GLFW_KEY_ENTER] = down;
#else
  io.AddKeyEvent(ImGuiKey_Enter, down);
#endif
}

TEST_F(Texts, EnterInTheBrowserOpensTheFirstFileThatCanBeOpened) {
  const test::TestFolder folder;
  folder.write("a.txt", "no recording");
  fs::copy_file(fs::path(GPO_SOURCE_DIR) / "sequences/orbit.yaml", folder.path() / "z.yaml");
  FolderLister lister;
  PanelInput shown = input();
  shown.lister = &lister;
  state_.view.browse = Browse{"open", (folder.path() / "").string()};
  Commands commands;
  const auto draw_once = [&] {
    context_.bind();
    commands = draw_workbench(shown, {kWidth, kHeight}, gui_, *views_);
  };
  const FolderList& list = views_->browser.listed;
  for (int i = 0; i < 3 || list.reading || list.entries.size() < 2; ++i) {
    ASSERT_LT(i, 5000);
    draw_once();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  hold_enter(true);
  draw_once();
  hold_enter(false);
  std::string lines;
  for (const Command& command : commands)
    if (const auto* action = command.target<RunAction>()) lines += action->line + "\n";
  EXPECT_THAT(lines, testing::HasSubstr("z.yaml"));
}

TEST_F(Texts, EnterInTheListOfCamerasOpensTheChosenMode) {
  const CameraDevice camera{0, "HD Webcam", {{{1280, 720}, 30}, {{640, 480}, 0}}};
  state_.view.sources = std::vector{camera};
  draw_times(3);
  hold_enter(true);
  const Commands commands = draw();
  hold_enter(false);
  EXPECT_EQ(test::line_of(commands), "live camera:0,1280x720,30");
}

/// Returns the first and last column in which two images differ; (columns, -1) if in none.
std::pair<int, int> differing_columns(const cv::Mat& a, const cv::Mat& b) {
  std::pair span(a.cols, -1);
  for (int x = 0; x < a.cols; ++x)
    if (!same_bytes(a.col(x).clone(), b.col(x).clone()))
      span = {std::min(span.first, x), std::max(span.second, x)};
  return span;
}

class ScanTexts : public Texts {
 protected:
  void scan(int starts, int of) {
    StartScan scan{.settings = {}, .step = 1, .of = of, .starts = {}};
    for (int i = 0; i < starts; ++i)
      scan.starts.push_back({.start = i, .ok = true, .readiness = Readiness::weak, .sigma_deg = 9});
    state_.results.scan = std::make_shared<const StartScan>(scan);
    state_.view.toggles.scan = true;
  }
};

TEST_F(ScanTexts, LabelIsBesideTheColumns) {
  scan(40, 40);
  const cv::Mat finished = image();
  scan(40, 100);
  const auto [first, last] = differing_columns(finished, image());
  EXPECT_GT(first, 0.85 * kWidth) << "the label covers columns";
  EXPECT_GT(last, first);
}

TEST_F(ScanTexts, ZoomedTimeLineSaysThatItShowsNoStart) {
  scan(3, 100);
  state_.view.time_span = {20, 12};
  state_.view.frame = 25;
  const cv::Mat running = image();
  state_.results.scan.reset();
  EXPECT_LT(differing_columns(running, image()).first, kWidth / 2) << "the strip is empty";
}

TEST_F(Texts, TowerIsNotDrawnBesideTheImage) {
  state_.view.toggles.legend = false;
  state_.view.toggles.tower = true;
  state_.document.cube_side = 1;
  const cv::Mat with_cube = image();
  state_.view.toggles.cube = false;
  const cv::Mat without = image();
  const Camera& camera = inspection_->recording->camera;
  const Rectangle& pane = layout_.image;
  const float height =
      pane.width * static_cast<float>(camera.height) / static_cast<float>(camera.width);
  const float margin = (pane.height - height) / 2;
  ASSERT_GT(margin, 20) << "there is no room above the image";
  const cv::Rect above(cv::Point2f(pane.x, pane.y), cv::Point2f(pane.right(), pane.y + margin - 2));
  const cv::Rect inside(cv::Point2f(pane.x, pane.y + margin),
                        cv::Point2f(pane.right(), pane.y + margin + height));
  EXPECT_TRUE(same_bytes(with_cube(above).clone(), without(above).clone()));
  EXPECT_FALSE(same_bytes(with_cube(inside).clone(), without(inside).clone()));
}

}  // namespace
}  // namespace gpo
