// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/curve_facts.h"

#include "engine/experiment/row.h"
#include "tests/ui/made_inspection.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/compared.h"
#include "ui/workbench/panes.h"
#include "ui/workbench/session/session_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Returns a state with a window of 30 frames and results of two methods at these lengths.
WorkbenchState state_with(const std::vector<int>& lengths, const MadeOptions& options = {}) {
  const Inspection made = made_inspection(options);
  WorkbenchState state;
  state.document.settings = made.settings;
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

TEST(CurveFacts, ShowErrorsOverTheComputedLengths) {
  const CurveFacts facts = curve_facts(state_with({30, 25}));
  EXPECT_THAT(titles(facts.figure), ElementsAre("ATE [mm]", "PNE [deg]", "PDE [mm]"));
  const Curve& gpo = facts.figure.charts[1].curves[0];
  EXPECT_EQ(gpo.name, "GPO");
  EXPECT_EQ(gpo.rgb, color_of(parse_configuration("gpo")));
  EXPECT_THAT(gpo.x, ElementsAre(25, 30));
  EXPECT_NEAR(gpo.y[0], 10.0 / 25, 1e-12);
  EXPECT_EQ(facts.done, 4);
  EXPECT_EQ(facts.of, 12);  // 5, 10, ..., 30 frames of two methods
  EXPECT_EQ(facts.note, "");
}

TEST(CurveFacts, CountAllRequestedWindows) {
  WorkbenchState state = state_with({});
  state.view.panes.drawer = find_drawer("curves");
  EXPECT_EQ(static_cast<std::size_t>(curve_facts(state).of), wanted_inspections(state).size());
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
  CachedCurveFacts cached;
  const CurveFacts& facts = cached.of(state);
  ASSERT_THAT(facts.configurations, SizeIs(1));
  EXPECT_EQ(facts.of, 0);
  EXPECT_DOUBLE_EQ(facts.figure.charts[1].curves[0].y[0], 0.4);  // the median
  run_line(state, "close-results");
  EXPECT_THAT(cached.of(state).configurations, SizeIs(2));
}

}  // namespace
}  // namespace gpo
