// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"
#include "tests/ui/window_test.h"
#include "ui/window_output.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::refusal, test::run_lines, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;

/// An inspection of `configuration`, in the survey of a state that has it open.
std::shared_ptr<Inspection> surveyed(WorkbenchState& state,
                                     const std::string& configuration,
                                     const MadeOptions& options = {}) {
  auto inspection = std::make_shared<Inspection>(made_inspection(options));
  if (!state.document.recording) {
    test::open(state, inspection);
    state.results.inspection.reset();
  }
  inspection->recording = state.document.recording;
  inspection->settings = apply(parse_configuration(configuration), state.document.settings);
  SurveyResults results = *state.results.surveyed;
  results.push_back({inspection->settings, inspection, ""});
  state.results.surveyed = std::make_shared<const SurveyResults>(std::move(results));
  return inspection;
}

std::vector<std::string> compared_keys(const WorkbenchState& state) {
  std::vector<std::string> keys;
  for (const Configuration& one : state.document.compared) keys.push_back(key_of(one));
  return keys;
}

std::vector<std::string> result_keys(const WorkbenchState& state) {
  std::vector<std::string> keys;
  for (const Compared& one : compared_results(state)) keys.push_back(key_of(one.configuration));
  return keys;
}

TEST(Compared, ActionsChangeTheList) {
  WorkbenchState state;
  EXPECT_THAT(compared_keys(state), ElementsAre("gpo", "pnp_ba", "ba", "pba"));
  run_line(state, "compare gpo,ba");
  run_line(state, "compare add gpo+no-ransac");
  run_line(state, "compare add ba");          // already there
  run_line(state, "compare add gpo+ransac");  // spells out a default
  EXPECT_THAT(compared_keys(state), ElementsAre("gpo", "ba", "gpo+no-ransac"));
  run_line(state, "compare remove ba");
  EXPECT_THAT(compared_keys(state), ElementsAre("gpo", "gpo+no-ransac"));
  run_line(state, "compare paper");
  EXPECT_THAT(compared_keys(state), ElementsAre("gpo", "pnp_ba", "ba", "pba"));
  run_line(state, "compare all");
  EXPECT_GT(state.document.compared.size(), methods().size());
}

TEST(Compared, RefusesUnknownMethodsAndKeepsTheLastOne) {
  WorkbenchState state;
  run_line(state, "compare gpo");
  for (const auto& [line, reason] : {std::pair{"compare add nonsense", "unknown method 'nonsense'"},
                                     {"compare remove ba", "'ba' is not compared"},
                                     {"compare remove gpo", "cannot remove the last one"},
                                     {"compare add", "compare add"}})
    EXPECT_THAT(refusal(state, line), HasSubstr(reason));
  EXPECT_THAT(compared_keys(state), ElementsAre("gpo"));
}

TEST(Compared, ConfigurationOfSettingsRoundTrips) {
  for (const Configuration& one : parse_configurations("all"))
    EXPECT_EQ(configuration_of(apply(one, Settings{})), one) << key_of(one);
  Settings settings;
  settings.options.ransac = true;  // gpo_joint's default
  EXPECT_EQ(key_of(configuration_of(settings)), "gpo_joint");
}

TEST(Compared, OtherSettingsAreThoseOfTheWindow) {
  WorkbenchState state;
  run_line(state, "method gpo");
  state.document.settings.tracking = Tracking::frame_to_frame;
  run_line(state, "compare gpo,ba");
  // Common settings are not part of the keys, so that names and colors stay.
  EXPECT_THAT(result_keys(state), ElementsAre("gpo", "ba"));
  for (const Compared& one : compared_results(state))
    EXPECT_EQ(one.settings.tracking, Tracking::frame_to_frame);
  run_line(state, "compare gpo,gpo+no-ransac");
  state.document.settings.options.ransac = false;  // the effect of a click on the second column
  EXPECT_THAT(result_keys(state), ElementsAre("gpo", "gpo+no-ransac"));
  run_line(state, "compare gpo,gpo+anchored");  // equal, because anchored is the default
  EXPECT_THAT(compared_keys(state), ElementsAre("gpo"));
  run_line(state, "compare gpo+anchored");
  state.document.settings.options.ransac.reset();
  state.document.settings.tracking = Tracking::anchored;
  EXPECT_THAT(result_keys(state), ElementsAre("gpo"));
}

TEST(Compared, FlipShowsTheFirstOtherResult) {
  WorkbenchState state;
  for (const auto& [line, key] : {std::pair{"method gpo", ""},
                                  {"flip on", "pnp_ba"},
                                  {"method ba", "gpo"},
                                  {"compare ba", ""},
                                  {"compare ba,ba+ransac", "ba+ransac"},
                                  {"flip off", ""}}) {
    run_line(state, line);
    const auto other = flipped_result(state);
    EXPECT_EQ(other ? key_of(other->configuration) : "", key) << line;
  }
}

TEST(Compared, FlipRequestsItsInspectionAndSwapsTheFirstTwoColumns) {
  WorkbenchState state;
  surveyed(state, "gpo");
  state.document.settings.options.method = "gpo";
  EXPECT_THAT(wanted_inspections(state), IsEmpty());
  const Action* flip = action_of_key('X', false);
  ASSERT_NE(flip, nullptr);
  EXPECT_TRUE(flip->held);
  run_line(state, flip->name + " on");
  const auto wanted = wanted_inspections(state);
  ASSERT_EQ(wanted.size(), 1U);
  EXPECT_EQ(wanted[0].options.method, "pnp_ba");
  EXPECT_EQ(wanted[0].frames, state.document.settings.frames);
  EXPECT_THAT(result_keys(state), ElementsAre("pnp_ba", "gpo", "ba", "pba"));
}

TEST(Compared, AReportWaitsForTheResultsAndTheirCurves) {
  WorkbenchState state;
  state.results.inspection = surveyed(state, "gpo");
  run_lines(state, "method gpo; compare gpo,ba; report a.html; screenshot b.png");
  const int frames = state.document.settings.frames;
  std::vector<std::pair<std::string, int>> wanted;
  for (const Settings& one : wanted_inspections(state))
    wanted.emplace_back(one.options.method.key(), one.frames);
  EXPECT_EQ(wanted.size(), 2 * curve_lengths(frames).size());
  EXPECT_THAT(wanted, testing::Contains(std::pair<std::string, int>("ba", 5)));
  const JobStatus status = report_status(state);
  EXPECT_TRUE(status.busy);
  EXPECT_EQ(status.done, 1);
  EXPECT_EQ(status.of, std::ssize(wanted));
  WorkerLink link;
  link.survey.busy = true;
  EXPECT_THAT(take_screenshots(state, link), testing::SizeIs(1)) << "the image does not wait";
  EXPECT_TRUE(wants_report(state));
  link.survey.busy = false;
  EXPECT_EQ(take_screenshots(state, link).at(0).file, "a.html");
  EXPECT_FALSE(wants_report(state));
}

TEST(Compared, MissingResultsArePendingOrHaveAReason) {
  WorkbenchState state;
  surveyed(state, "gpo");
  run_lines(state, "method gpo; compare gpo,ba,pba");
  SurveyResults results = *state.results.surveyed;
  results.push_back(
      {apply(parse_configuration("pba"), state.document.settings), nullptr, "no gyroscope"});
  state.results.surveyed = std::make_shared<const SurveyResults>(results);
  const auto all = compared_results(state);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_NE(all[0].inspection, nullptr);
  EXPECT_EQ(all[1].inspection, nullptr);
  EXPECT_EQ(all[1].error, "");
  EXPECT_EQ(all[2].error, "no gyroscope");
}

TEST(Compared, AllCubesAreOnOneRay) {
  WorkbenchState state;
  surveyed(state, "gpo");
  surveyed(state, "ba", {.estimate_error = 5});
  run_lines(state, "method gpo; compare gpo,ba");
  // Not moved by the user: the ray of the first result.
  const auto all = compared_results(state);
  ASSERT_TRUE(all[0].inspection && all[1].inspection);
  EXPECT_LT(angle_deg(all[0].inspection->cube->origin, all[1].inspection->cube->origin), 1e-5);
  state.document.cube_ray = Eigen::Vector3d(0.1, 0.05, 1);
  for (const Compared& one : compared_results(state))
    EXPECT_LT(angle_deg(one.inspection->cube->origin, *state.document.cube_ray), 1e-5);
}

TEST(Compared, ColumnsBeginWithTheCurrentMethodIfItIsNotCompared) {
  WorkbenchState state;
  surveyed(state, "gpo");
  run_lines(state, "method pba; compare gpo,ba");
  EXPECT_THAT(result_keys(state), ElementsAre("pba", "gpo", "ba"));
  state.view.panes.compare = true;
  EXPECT_EQ(wanted_inspections(state).size(), 3U);
  run_line(state, "method ba");
  EXPECT_THAT(result_keys(state), ElementsAre("gpo", "ba"));
}

TEST(Compared, CurrentResultComesFirstIfNotCompared) {
  WorkbenchState state;
  state.results.inspection = surveyed(state, "gpo");
  run_line(state, "compare ba");
  state.document.settings = state.results.inspection->settings;
  auto all = compared_with_current(state);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(key_of(all[0].configuration), "gpo");
  EXPECT_NE(all[0].inspection, nullptr);
  state.document.settings.options.ransac_threshold_px = 3;  // makes its result outdated
  EXPECT_EQ(compared_with_current(state)[0].inspection, nullptr);
  run_line(state, "compare ba,gpo");
  all = compared_with_current(state);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(key_of(all[0].configuration), "ba");
}

TEST(Compared, ZoomIsKeptUntilFit) {
  WorkbenchState state;
  surveyed(state, "gpo");
  run_line(state, "compare zoom 4 0 0");
  EXPECT_EQ(state.view.compare_zoom, (ImageZoom{4, {0, 0}}));
  EXPECT_EQ(state.view.image_zoom.factor, 1);
  run_line(state, "compare zoom");
  EXPECT_FALSE(state.view.compare_zoom);
  run_lines(state, "compare zoom 2; fit");
  EXPECT_FALSE(state.view.compare_zoom);
  EXPECT_THAT(refusal(state, "compare zoom much"), HasSubstr("compare zoom"));
}

TEST(Compared, CurvesAreToggledByName) {
  WorkbenchState state;
  using Keys = std::vector<std::string>;
  for (const auto& [line, hidden] : {std::pair{"curve ba", Keys{"ba"}},
                                     {"curve ba off", {"ba"}},
                                     {"curve ba", {}},
                                     {"curve gpo+ransac off", {"gpo"}}}) {  // equal to gpo
    run_line(state, line);
    EXPECT_EQ(state.view.hidden_curves, hidden) << line;
  }
  EXPECT_THAT(refusal(state, "curve gpo perhaps"), HasSubstr("expected on or off"));
}

TEST(Compared, CurveLengthsAreTheWindowAndMultiplesOfFive) {
  EXPECT_THAT(curve_lengths(12), ElementsAre(12, 10, 5));
  EXPECT_THAT(curve_lengths(10), ElementsAre(10, 5));
  EXPECT_THAT(curve_lengths(3), ElementsAre(3));
}

TEST(ShownResults, AreTheCurrentOneAndTheComputedComparedOnes) {
  WorkbenchState state;
  EXPECT_TRUE(shown_results(state).empty());
  Inspection made = made_inspection();
  made.settings.options.method = "gpo";
  const auto current = std::make_shared<const Inspection>(made);
  state.results.inspection = current;
  state.document.compared = parse_configurations("gpo,ba,gpo+no-ransac");
  const Settings& settings = current->settings;
  SurveyResults surveyed;
  for (const char* key : {"gpo", "gpo+no-ransac"})
    surveyed.push_back({apply(parse_configuration(key), settings), current, ""});
  Settings shorter = apply(parse_configuration("ba"), settings);
  --shorter.frames;
  surveyed.push_back({shorter, current, ""});
  surveyed.push_back({apply(parse_configuration("ba"), settings), nullptr, "does not work"});
  state.results.surveyed = std::make_shared<const SurveyResults>(surveyed);
  const auto shown = shown_results(state);
  ASSERT_EQ(shown.size(), 2U) << "ba is computed for another window only";
  EXPECT_TRUE(shown[0].current);
  EXPECT_EQ(shown[0].name, "GPO");
  EXPECT_FALSE(shown[1].current);
  EXPECT_EQ(shown[1].name, title_of(parse_configuration("gpo+no-ransac")));
  EXPECT_EQ(shown[1].rgb, color_of(parse_configuration("gpo+no-ransac")));
}

}  // namespace
}  // namespace gpo
