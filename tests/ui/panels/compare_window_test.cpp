// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"
#include "ui/context/offscreen_context.h"
#include "ui/context/theme.h"
#include "ui/panels/facts/compare_facts.h"
#include "ui/panels/panes/view_options.h"
#include "ui/views/compare/compare_view.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/commands.h"
#include "ui/workbench/panes.h"
#include "ui/workbench/session/session_file.h"
#include "ui/workbench_window.h"

#include <algorithm>
#include <filesystem>

#include <gmock/gmock.h>
#include <imgui.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

/// The window off-screen with GPO and BA compared, BA's estimate tilted by 4 degrees; a mouse.
class CompareWindow : public DrawingTest {
 protected:
  static constexpr int kWidth = 1280, kHeight = 720;

  void SetUp() override {
    DrawingTest::SetUp();
    auto own = std::make_shared<Inspection>(made_inspection());
    own->settings.options.method = "gpo";
    state_.document.settings = own->settings;
    apply_recording(state_, own->recording);
    state_.results.inspection = own;
    state_.document.compared = parse_configurations("gpo,ba");
    add("gpo", {});
    add("ba", {.estimate_error = 4});
    apply(state_, GoToFrame{24});
  }

  void add(const std::string& key, const MadeOptions& options) {
    auto one = std::make_shared<Inspection>(made_inspection(options));
    one->recording = state_.document.recording;
    one->settings = gpo::apply(parse_configuration(key), state_.document.settings);
    SurveyResults results = *state_.results.surveyed;
    results.push_back({one->settings, one, ""});
    state_.results.surveyed = std::make_shared<const SurveyResults>(results);
  }

  PanelInput input() { return {state_, idle_, no_survey_, true, gui_.scale()}; }
  Commands draw() {
    context_.bind();
    return draw_workbench(input(), {kWidth, kHeight}, gui_, views_);
  }
  cv::Mat view(const std::string& name, const std::string& file = "") {
    const cv::Mat image = draw_view({name, cv::Size(900, 500)}, input(), gui_, views_);
    if (file.empty()) return image;
    std::filesystem::create_directories(GPO_TEST_OUTPUT_DIR);
    cv::imwrite(std::string(GPO_TEST_OUTPUT_DIR) + "/" + file, image);
    return image;
  }
  void point_at(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    draw();
    draw();
  }
  Commands click(float x, float y) {
    point_at(x, y);
    ImGui::GetIO().MouseDown[0] = true;
    Commands all = draw();
    ImGui::GetIO().MouseDown[0] = false;
    for (const Command& command : draw()) push(all, command);
    return all;
  }
  template <class C>
  static const C* find(const Commands& commands) {
    for (const Command& command : commands)
      if (const C* found = std::get_if<C>(&command)) return found;
    return nullptr;
  }

  OffscreenContext context_{kWidth, kHeight};
  Gui gui_;
  Views views_;
  WorkbenchState state_;
  JobStatus idle_;
  SurveyStatus no_survey_;
  WindowLayout layout_ = window_layout({kWidth, kHeight});
};

int count(const cv::Mat& image, std::uint32_t rgb) {
  const cv::Vec3i wanted(rgb & 0xFF, rgb >> 8 & 0xFF, rgb >> 16);
  int pixels = 0;
  for (const cv::Vec3b& bgr : cv::Mat_<cv::Vec3b>(image))
    pixels += cv::norm(cv::Vec3i(bgr) - wanted, cv::NORM_INF) <= 6 ? 1 : 0;
  return pixels;
}

TEST_F(CompareWindow, AHeadingMakesItsMethodTheCurrentOne) {
  state_.view.panes.compare = true;
  draw();
  const Commands commands =
      click(layout_.views.x + layout_.views.width * 0.75F, layout_.views.y + 90);
  ASSERT_NE(find<ChangeSettings>(commands), nullptr);
  EXPECT_EQ(find<ChangeSettings>(commands)->settings.options.method, "ba");
}

TEST_F(CompareWindow, TheWheelZoomsAllColumnsAroundTheSamePoint) {
  state_.view.panes.compare = true;
  run_line(state_, "compare zoom 2");
  draw();
  const auto zoomed_at = [&](float x) {
    point_at(x, layout_.views.y + 300);
    ImGui::GetIO().MouseWheel = 1;
    const Commands commands = draw();
    ImGui::GetIO().MouseWheel = 0;
    EXPECT_NE(find<ZoomCompare>(commands), nullptr);
    return find<ZoomCompare>(commands)->zoom.value();
  };
  // At the same place of the first and of the second column.
  const float column = std::floor((layout_.views.width - 12) / 2);
  const ImageZoom first = zoomed_at(layout_.views.x + 100);
  const ImageZoom second = zoomed_at(layout_.views.x + 100 + column);
  EXPECT_DOUBLE_EQ(first.factor, 2.5);
  EXPECT_NEAR((first.center - second.center).norm(), 0, 1e-9);
  EXPECT_NE(first.center, Eigen::Vector2d(0.5, 0.5));
}

TEST_F(CompareWindow, AChipsCrossRemovesIt) {
  state_.view.panes.compare = true;
  draw();
  bool removed = false;
  for (float x = layout_.views.x + 20; x < layout_.views.x + 120 && !removed; x += 6) {
    const Commands commands = click(x, layout_.views.y + 18);
    const auto* action = find<RunAction>(commands);
    removed = action != nullptr && action->line == "compare remove gpo";
  }
  EXPECT_TRUE(removed);
}

TEST_F(CompareWindow, WhatIsMissingSaysSoInItsPlace) {
  const cv::Mat whole = view("compare", "compare_two.png");
  state_.document.compared.push_back({"pba"});
  const cv::Mat three = view("compare", "compare_missing.png");
  const cv::Mat last = three.colRange(610, 900);
  EXPECT_GT(count(last, color_of(Role::accent)), 30);  // "computing"
  EXPECT_EQ(count(last, color_of(Role::cube_base)), 0);
  EXPECT_GT(count(whole.colRange(460, 900), color_of(Role::cube_base)), 100);
}

TEST_F(CompareWindow, FlipSwapsTheColumnsInPlace) {
  const cv::Mat before = view("compare");
  state_.view.flip = true;
  const cv::Mat after = view("compare");
  const cv::Rect first(12, 92, 430, 300), second(12 + 444, 92, 430, 300);
  // Elsewhere on the screen the rims of lines are rounded otherwise.
  const double moved = cv::norm(before(first), after(second), cv::NORM_L1);
  EXPECT_LT(10 * moved, cv::norm(before(first), after(first), cv::NORM_L1));
  EXPECT_LT(10 * moved, cv::norm(before(second), after(second), cv::NORM_L1));
}

TEST_F(CompareWindow, FlipShowsTheOtherResultInTheImageAndSaysWhose) {
  const cv::Mat own = view("picture");
  state_.view.flip = true;
  const cv::Mat other = view("picture", "flip.png");
  EXPECT_FALSE(same_bytes(own, other));
  const cv::Mat label = other(cv::Rect(700, 5, 200, 45));
  EXPECT_GT(count(label, color_of(parse_configuration("ba"))), 100);
  state_.results.surveyed = std::make_shared<const SurveyResults>();
  EXPECT_FALSE(same_bytes(other, view("picture", "flip_computing.png")));
  draw();  // in the window, too
}

TEST_F(CompareWindow, ARowOfTheTableMakesItsMethodTheCurrentOne) {
  state_.view.panes.drawer = find_drawer("table");
  const WindowLayout layout =
      window_layout({.width = kWidth, .height = kHeight, .drawer_open = true});
  draw();
  draw();
  bool chosen = false;
  for (float y = layout.drawer.y + 30; y < layout.drawer.bottom() && !chosen; y += 8) {
    const Commands commands = click(layout.drawer.x + 60, y);
    const auto* change = find<ChangeSettings>(commands);
    chosen = change != nullptr && change->settings.options.method == "ba";
  }
  EXPECT_TRUE(chosen);
  view("table", "table.png");
}

TEST_F(CompareWindow, AClickInACurveGoesToTheFrameWhereThatWindowEnds) {
  for (const int length : {5, 10, 15, 20, 25}) {
    Settings settings = state_.document.settings;
    for (const char* key : {"gpo", "ba"}) {
      auto one = std::make_shared<Inspection>(*state_.results.inspection);
      one->settings = gpo::apply(parse_configuration(key), settings);
      one->settings.frames = length;
      one->evaluation->ate_m = 0.001 * length;
      one->evaluation->pne_deg = 1.0 / length;
      one->evaluation->pde_m = 0.01 / length;
      SurveyResults results = *state_.results.surveyed;
      results.push_back({one->settings, one, ""});
      state_.results.surveyed = std::make_shared<const SurveyResults>(results);
    }
  }
  state_.view.panes.drawer = find_drawer("curves");
  const WindowLayout layout =
      window_layout({.width = kWidth, .height = kHeight, .drawer_open = true});
  draw();
  const float y = layout.drawer.y + layout.drawer.height / 2;
  const Commands early = click(layout.drawer.x + 80, y);
  const Commands late = click(layout.drawer.x + layout.drawer.width / 3 - 40, y);
  ASSERT_TRUE(find<GoToFrame>(early) && find<GoToFrame>(late));
  EXPECT_LT(find<GoToFrame>(early)->frame, find<GoToFrame>(late)->frame);
  EXPECT_GE(find<GoToFrame>(early)->frame, state_.document.settings.start + 4);
  EXPECT_LE(find<GoToFrame>(late)->frame, state_.document.settings.start + 29);
  const cv::Mat both = view("curves", "curves.png");
  run_line(state_, "curve ba off");
  EXPECT_FALSE(same_bytes(both, view("curves")));
}

TEST_F(CompareWindow, ANameOfTheLegendSwitchesItsCurves) {
  state_.view.panes.drawer = find_drawer("curves");
  const WindowLayout layout =
      window_layout({.width = kWidth, .height = kHeight, .drawer_open = true});
  draw();
  const Commands commands = click(layout.drawer.x + 40, layout.drawer.y + 14);
  ASSERT_NE(find<RunAction>(commands), nullptr);
  EXPECT_EQ(find<RunAction>(commands)->line, "curve gpo off");
}

TEST_F(CompareWindow, IsDrawnAtAnySizeAndWhateverIsThere) {
  state_.view.panes.compare = true;
  for (const char* drawer : {"table", "curves"}) {
    state_.view.panes.drawer = find_drawer(drawer);
    for (const char* compared : {"gpo", "gpo,ba,pba", "all"}) {
      run_line(state_, std::string("compare ") + compared);
      for (const cv::Size size : {cv::Size(1024, 640), cv::Size(1920, 1080), cv::Size(64, 48)})
        draw_view({"window", size}, input(), gui_, views_);
    }
  }
  state_.results.inspection.reset();
  state_.results.surveyed = std::make_shared<const SurveyResults>();
  draw();
}

}  // namespace
}  // namespace gpo
