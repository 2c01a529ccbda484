// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/window_test.h"
#include "ui/context/gui.h"
#include "ui/views/compare/compare_view.h"
#include "ui/workbench/layout.h"

#include <cmath>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::find, test::first, test::line_of;

/// The window with GPO and BA compared; the estimate of BA is tilted by 4 degrees.
class CompareWindow : public test::WindowTest {
 protected:
  CompareWindow() {
    Inspection own = made_inspection();
    own.settings.options.method = "gpo";
    open(own);
    state_.document.compared = parse_configurations("gpo,ba");
    add("gpo", made_inspection());
    add("ba", made_inspection({.estimate_error = 4}));
    apply(state_, GoToFrame{24});
  }
  /// Adds a result of a method; `frames`: length of its window, 0: that of the state.
  void add(const std::string& key, const Inspection& inspection, int frames = 0) {
    auto one = std::make_shared<Inspection>(inspection);
    one->recording = state_.document.recording;
    one->settings = gpo::apply(parse_configuration(key), state_.document.settings);
    if (frames > 0) one->settings.frames = frames;
    SurveyResults results = *state_.results.surveyed;
    results.push_back({one->settings, one, ""});
    state_.results.surveyed = std::make_shared<const SurveyResults>(results);
  }
  cv::Mat view(const std::string& name, const std::string& file = "") {
    const cv::Mat image = WindowTest::view(name, cv::Size(900, 500));
    if (!file.empty()) keep(file, image);
    return image;
  }
};

TEST_F(CompareWindow, ClickOnAHeadingChoosesItsMethod) {
  state_.view.panes.compare = true;
  draw();
  const float x = layout_.views.x + layout_.views.width * 0.75F;
  EXPECT_EQ(first<ChangeSettings>(click(x, layout_.views.y + 90)).settings.options.method, "ba");
}

TEST_F(CompareWindow, ZoomsAllColumnsAroundTheSamePoint) {
  state_.view.panes.compare = true;
  run_line(state_, "compare zoom 2");
  draw();
  const auto zoomed_at = [&](float x) {
    const auto zoomed = first<ZoomCompare>(wheel(x, layout_.views.y + 300));
    ImGui::GetIO().MouseWheel = 0;
    return zoomed.zoom.value();
  };
  // The same position in the first and in the second column.
  const float column = std::floor((layout_.views.width - 12) / 2);
  const ImageZoom left = zoomed_at(layout_.views.x + 100);
  const ImageZoom right = zoomed_at(layout_.views.x + 100 + column);
  EXPECT_DOUBLE_EQ(left.factor, 2.5);
  EXPECT_NEAR((left.center - right.center).norm(), 0, 1e-9);
  EXPECT_NE(left.center, Eigen::Vector2d(0.5, 0.5));
}

TEST_F(CompareWindow, RemovesAChipByItsCross) {
  state_.view.panes.compare = true;
  draw();
  bool removed = false;
  for (float x = layout_.views.x + 20; x < layout_.views.x + 120 && !removed; x += 6)
    removed = line_of(click(x, layout_.views.y + 18)) == "compare remove gpo";
  EXPECT_TRUE(removed);
}

TEST_F(CompareWindow, ShowsMissingResultsAsComputing) {
  const cv::Mat whole = view("compare", "compare_two");
  state_.document.compared.push_back({"pba"});
  const cv::Mat three = view("compare", "compare_missing");
  const cv::Mat last = three.colRange(610, 900);
  EXPECT_GT(count_pixels(last, color_of(Role::accent)), 30);  // "computing"
  EXPECT_EQ(count_pixels(last, color_of(Role::cube_base)), 0);
  EXPECT_GT(count_pixels(whole.colRange(460, 900), color_of(Role::cube_base)), 100);
}

TEST_F(CompareWindow, FlipSwapsTheColumns) {
  const cv::Mat before = view("compare");
  state_.view.flip = true;
  const cv::Mat after = view("compare");
  const cv::Rect left(12, 92, 430, 300), right(12 + 444, 92, 430, 300);
  // Lines are antialiased differently at another position.
  const double moved = cv::norm(before(left), after(right), cv::NORM_L1);
  for (const cv::Rect& place : {left, right})
    EXPECT_LT(10 * moved, cv::norm(before(place), after(place), cv::NORM_L1));
}

TEST_F(CompareWindow, FlipShowsTheOtherResultWithItsName) {
  const cv::Mat own = view("picture");
  state_.view.flip = true;
  const cv::Mat other = view("picture", "flip");
  EXPECT_FALSE(same_bytes(own, other));
  const cv::Mat label = other(cv::Rect(700, 5, 200, 45));
  EXPECT_GT(count_pixels(label, color_of(parse_configuration("ba"))), 100);
  state_.results.surveyed = std::make_shared<const SurveyResults>();
  EXPECT_FALSE(same_bytes(other, view("picture", "flip_computing")));
  draw();
}

TEST_F(CompareWindow, ClickOnARowChoosesItsMethod) {
  state_.view.panes.drawer = find_drawer("table");
  const Rectangle place = layout().drawer;
  draw();
  draw();
  bool chosen = false;
  for (float y = place.y + 30; y < place.bottom() && !chosen; y += 8) {
    const Commands commands = click(place.x + 60, y);
    const auto* change = find<ChangeSettings>(commands);
    chosen = change != nullptr && change->settings.options.method == "ba";
  }
  EXPECT_TRUE(chosen);
  view("table", "table");
}

TEST_F(CompareWindow, ClickInACurveGoesToTheEndOfThatWindow) {
  for (const int length : {5, 10, 15, 20, 25}) {
    Inspection one = *state_.results.inspection;
    one.evaluation->ate_m = 0.001 * length;
    one.evaluation->pne_deg = 1.0 / length;
    one.evaluation->pde_m = 0.01 / length;
    for (const char* key : {"gpo", "ba"}) add(key, one, length);
  }
  state_.view.panes.drawer = find_drawer("curves");
  const Rectangle place = layout().drawer;
  draw();
  const float y = place.y + place.height / 2;
  const int early = first<GoToFrame>(click(place.x + 80, y)).frame;
  const int late = first<GoToFrame>(click(place.x + place.width / 3 - 40, y)).frame;
  EXPECT_LT(early, late);
  EXPECT_GE(early, state_.document.settings.start + 4);
  EXPECT_LE(late, state_.document.settings.start + 29);
  const cv::Mat both = view("curves", "curves");
  run_line(state_, "curve ba off");
  EXPECT_FALSE(same_bytes(both, view("curves")));
}

TEST_F(CompareWindow, ClickInTheLegendHidesItsCurves) {
  state_.view.panes.drawer = find_drawer("curves");
  draw();
  const Rectangle place = layout().drawer;
  EXPECT_EQ(line_of(click(place.x + 40, place.y + 14)), "curve gpo off");
}

TEST_F(CompareWindow, DrawsAtAnySizeWithAndWithoutResults) {
  state_.view.panes.compare = true;
  for (const char* drawer : {"table", "curves"}) {
    state_.view.panes.drawer = find_drawer(drawer);
    for (const char* compared : {"gpo", "gpo,ba,pba", "all"}) {
      run_line(state_, std::string("compare ") + compared);
      for (const cv::Size size : {cv::Size(1024, 640), cv::Size(1920, 1080), cv::Size(64, 48)})
        WindowTest::view("window", size);
    }
  }
  state_.results.inspection.reset();
  state_.results.surveyed = std::make_shared<const SurveyResults>();
  draw();
}

}  // namespace
}  // namespace gpo
