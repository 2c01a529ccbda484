// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/row.h"
#include "tests/ui/window_test.h"
#include "ui/context/gui.h"
#include "ui/look/look.h"
#include "ui/panels/facts/facts.h"
#include "ui/views/compare/compare_view.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/layout.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::find, test::first, test::line_of, testing::ElementsAre, testing::HasSubstr;
using testing::IsEmpty, testing::SizeIs;

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
    return zoomed.value.value();
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
  state_.view.panes.drawer = find_pane("table", drawers());
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
  state_.view.panes.drawer = find_pane("curves", drawers());
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
  state_.view.panes.drawer = find_pane("curves", drawers());
  draw();
  const Rectangle place = layout().drawer;
  EXPECT_EQ(line_of(click(place.x + 40, place.y + 14)), "curve gpo off");
}

TEST_F(CompareWindow, DrawsAtAnySizeWithAndWithoutResults) {
  state_.view.panes.compare = true;
  for (const char* drawer : {"table", "curves"}) {
    state_.view.panes.drawer = find_pane(drawer, drawers());
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

Compared made(double pne_deg, double rms_px, const MadeOptions& options = {}) {
  auto inspection = std::make_shared<Inspection>(made_inspection(options));
  if (inspection->evaluation) inspection->evaluation->pne_deg = pne_deg;
  auto result = std::make_shared<Initialization>(*inspection->initialization);
  result->transfer_rms_px = rms_px;
  inspection->initialization = result;
  inspection->timing.initialize = 2;
  return {configuration_of(inspection->settings), inspection->settings, inspection, ""};
}

int column_named(const std::string& title) {
  const auto columns = compared_columns();
  return std::ranges::find(columns, title, &ComparedColumn::title) - columns.begin();
}

const ComparedNumber& number(const ComparedRow& row, const std::string& title) {
  return row.numbers.at(column_named(title));
}

TEST(CompareFacts, DifferFromTheFirstRowAbsolutelyAndRelativelyOrByAFactor) {
  const auto rows = compared_rows({made(0.2, 0.5), made(0.3, 0.25), made(0.2, 0.5)}, true);
  EXPECT_EQ(number(rows[0], "PNE").difference, "");
  EXPECT_EQ(number(rows[1], "PNE").text, "0.300\u00b0");
  EXPECT_EQ(number(rows[1], "PNE").difference, "+0.100\u00b0 +50 %");
  EXPECT_EQ(number(rows[1], "Transfer RMS").difference, "\u22120.250 px \u221250 %");
  EXPECT_EQ(number(rows[2], "PNE").difference, "\u00b10");
  const auto close = compared_rows({made(0.4, 0.5), made(0.399, 0.5)}, true);
  EXPECT_EQ(number(close[1], "PNE").difference, "\u22120.001\u00b0") << "not also by 0 %";
  const auto far = compared_rows({made(0.01, 0.5), made(0.5, 0.5)}, true);
  EXPECT_THAT(number(far[1], "PNE").difference, HasSubstr("\u00d750"));
}

TEST(CompareFacts, LimitWorseToOneOctave) {
  const auto rows = compared_rows({made(0.2, 0.5), made(0.3, 0.25), made(2, 0.49)}, true);
  EXPECT_NEAR(number(rows[1], "PNE").worse, std::log2(1.5), 1e-9);
  EXPECT_DOUBLE_EQ(number(rows[1], "Transfer RMS").worse, 0) << "a small one proves nothing";
  EXPECT_DOUBLE_EQ(number(rows[2], "PNE").worse, 1);
  EXPECT_DOUBLE_EQ(number(rows[0], "PNE").worse, 0);
  EXPECT_DOUBLE_EQ(number(rows[1], "Inliers").worse, 0) << "neither is better";
}

TEST(CompareFacts, ExplainUnknownValues) {
  const auto blind = compared_rows({made(0, 0.5, {.truth = false})}, false);
  EXPECT_EQ(number(blind[0], "PNE").text, "\u2013");
  EXPECT_THAT(number(blind[0], "PNE").why_not, HasSubstr("no ground truth"));
  EXPECT_EQ(number(blind[0], "Initialize").text, "\u2013");
  EXPECT_THAT(number(blind[0], "Initialize").why_not, HasSubstr("omit times"));
  EXPECT_EQ(number(compared_rows({made(0, 0.5)}, true)[0], "Initialize").text, "2.0 ms");
}

TEST(CompareFacts, NameFailedAndUnfinishedResults) {
  Compared failed = made(0, 0, {.ok = false}), missing = made(0, 0), refused = made(0, 0);
  missing.inspection.reset();
  refused.inspection.reset();
  refused.error = "no gyroscope";
  const auto rows = compared_rows({made(0.2, 0.5), failed, missing, refused}, true);
  EXPECT_EQ(rows[1].status, "failed");
  EXPECT_EQ(rows[1].reason, failed.inspection->initialization->reason);
  EXPECT_EQ(number(rows[1], "Transfer RMS").difference, "");
  EXPECT_EQ(rows[2].status, "computing");
  EXPECT_THAT(rows[2].numbers, IsEmpty());
  EXPECT_EQ(rows[3].status, "not computed");
  EXPECT_EQ(rows[3].reason, "no gyroscope");
}

TEST(CompareFacts, SortByAColumnWithUnknownValuesLast) {
  const auto all = compared_rows({made(0.2, 0.5), made(0, 0, {.ok = false}), made(0.1, 0.3)}, true);
  const int rms = column_named("Transfer RMS");
  EXPECT_THAT(in_order(all, {}), ElementsAre(0, 1, 2));
  EXPECT_THAT(in_order(all, {rms, false}), ElementsAre(2, 0, 1));
  EXPECT_THAT(in_order(all, {rms, true}), ElementsAre(0, 2, 1));
}

TEST(CompareFacts, WriteCsvWithUnitsAndFullPrecision) {
  const auto rows = compared_rows({made(0.25, 0.5), made(0, 0, {.ok = false})}, false);
  const std::string csv = to_csv(rows);
  EXPECT_THAT(csv,
              testing::StartsWith(
                  "method,status,Inliers,Transfer RMS [px],Reprojection RMS "
                  "[px],Iterations,Initialize [ms],PNE [deg],PNE aligned [deg],PDE [m],ATE [m],"));
  for (const char* part : {",ok,", ",0.5,", ",0.25,", ",failed,,,,"})
    EXPECT_THAT(csv, HasSubstr(part));
}

/// Returns a state with a window of 30 frames and results of two methods at these lengths.
WorkbenchState state_with(const std::vector<int>& lengths, const MadeOptions& options = {}) {
  const Inspection made = made_inspection(options);
  WorkbenchState state;
  state.document.settings = made.settings;
  state.document.settings.options.method = "gpo";
  apply_recording(state, made.recording);
  state.document.compared = parse_configurations("gpo,ba");
  SurveyResults results;
  for (const int length : lengths)
    for (const char* key : {"gpo", "ba"}) {
      auto one = std::make_shared<Inspection>(made);
      one->settings = apply(parse_configuration(key), state.document.settings);
      one->settings.frames = length;
      if (one->evaluation) one->evaluation->pne_deg = 10.0 / length;
      results.push_back({one->settings, one, ""});
    }
  state.results.surveyed = std::make_shared<const SurveyResults>(results);
  return state;
}

std::vector<std::string> titles(const Figure& figure) {
  std::vector<std::string> titles;
  for (const Chart& chart : figure.charts) titles.push_back(chart.y_label);
  return titles;
}

TEST(CurveFacts, ShowErrorsOverTheComputedLengthsAndCountAllRequestedWindows) {
  WorkbenchState state = state_with({30, 25});
  const CurveFacts facts = curve_facts(state);
  EXPECT_THAT(titles(facts.figure), ElementsAre("ATE [mm]", "PNE [deg]", "PDE [mm]"));
  const Curve& gpo = facts.figure.charts[1].curves[0];
  EXPECT_EQ(gpo.name, "GPO");
  EXPECT_EQ(gpo.rgb, color_of(parse_configuration("gpo")));
  EXPECT_THAT(gpo.x, ElementsAre(25, 30));
  EXPECT_NEAR(gpo.y[0], 10.0 / 25, 1e-12);
  EXPECT_EQ(facts.done, 4);
  EXPECT_EQ(facts.of, 12);  // 5, 10, ..., 30 frames of two methods
  EXPECT_EQ(facts.note, "");
  state.view.panes.drawer = find_pane("curves", drawers());
  EXPECT_THAT(wanted_inspections(state), SizeIs(facts.of));
}

TEST(CurveFacts, ShowTheCurrentMethodFirstIfItIsNotCompared) {
  WorkbenchState state = state_with({30, 25});
  run_line(state, "method pba");
  const CurveFacts facts = curve_facts(state);
  ASSERT_THAT(facts.configurations, SizeIs(3));
  EXPECT_EQ(key_of(facts.configurations[0]), "pba");
  EXPECT_EQ(facts.of, 18);
  state.view.panes.drawer = find_pane("curves", drawers());
  EXPECT_THAT(wanted_inspections(state), SizeIs(facts.of));
  EXPECT_EQ(wanted_inspections(state)[0].options.method, "pba");
}

TEST(CurveFacts, NameHiddenCurvesWithoutDrawingThem) {
  WorkbenchState state = state_with({30, 25});
  run_line(state, "curve gpo off");
  const CurveFacts facts = curve_facts(state);
  EXPECT_THAT(facts.configurations, SizeIs(2));
  ASSERT_THAT(facts.figure.charts[0].curves, SizeIs(1));
  EXPECT_EQ(facts.figure.charts[0].curves[0].name, "BA");
  run_line(state, "curve ba off");
  EXPECT_THAT(curve_facts(state).figure.charts, IsEmpty());
}

TEST(CurveFacts, ShowRmsAndUncertaintyWithoutTruth) {
  const MadeOptions blind{.truth = false, .normal_sigma_deg = 0.3};
  const CurveFacts facts = curve_facts(state_with({30, 25}, blind));
  EXPECT_THAT(titles(facts.figure), ElementsAre("RMS [px]", "\u03c3 [deg]"));
  EXPECT_THAT(facts.figure.charts[1].curves[0].y, ElementsAre(0.3, 0.3));
  EXPECT_THAT(facts.note, HasSubstr("no ground truth"));
}

TEST(CurveFacts, ShowAFileUntilItIsClosed) {
  WorkbenchState state = state_with({30});
  Settings settings;
  std::vector<Row> rows;
  for (const double pne : {0.2, 0.4, 0.9}) {
    settings.frames = 10;
    rows.push_back(refused_row("desk", apply(parse_configuration("pba"), settings), ""));
    rows.back().status = "ok";
    rows.back().pne_deg = pne;
    settings.start += 10;
  }
  state.results.experiment = std::make_shared<const std::vector<Row>>(rows);
  Cached<CurveInputs, CurveFacts> cached;
  const auto update = [&] {
    return cached.update(curve_inputs(state), [&] { return curve_facts(state); });
  };
  EXPECT_TRUE(update());
  EXPECT_FALSE(update());
  const CurveFacts& facts = cached.value;
  ASSERT_THAT(facts.configurations, SizeIs(1));
  EXPECT_EQ(facts.of, 0);
  EXPECT_DOUBLE_EQ(facts.figure.charts[1].curves[0].y[0], 0.4);  // the median
  run_line(state, "close-results");
  EXPECT_TRUE(update());
  EXPECT_THAT(facts.configurations, SizeIs(2));
}

}  // namespace
}  // namespace gpo
