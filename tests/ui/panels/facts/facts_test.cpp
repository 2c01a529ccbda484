// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/pose.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"
#include "tests/ui/made_inspection.h"
#include "ui/look/look.h"
#include "ui/panels/timeline/timeline_bars.h"
#include "ui/views/report/report.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Rows = std::map<std::string, ResultRow>;
using testing::AllOf, testing::ElementsAre, testing::HasSubstr, testing::Not;

std::vector<std::int64_t> times(int count, double rate_hz) {
  std::vector<std::int64_t> all(count);
  for (int i = 0; i < count; ++i) all[i] = static_cast<std::int64_t>(i * 1e9 / rate_hz);
  return all;
}

Recording desk_recording() {
  Recording recording;
  recording.name = "desk";
  recording.camera.width = 640;
  recording.camera.height = 480;
  recording.timestamps_ns = times(60, 30);
  recording.gyroscope = Gyroscope{};
  recording.gyroscope->timestamps_ns = times(400, 200);
  recording.truth = GroundTruth{};
  return recording;
}

Inspection inspected() {
  Inspection inspection;
  inspection.recording = std::make_shared<const Recording>(desk_recording());
  auto window = std::make_shared<Window>();
  window->points_px = {Eigen::Matrix2Xd::Zero(2, 3)};
  window->inlier = {{true, true, false}};
  inspection.window = window;
  auto result = std::make_shared<Initialization>();
  result->ok = true;
  result->transfer_rms_px = 0.4321;
  result->solver = {9, 100, 20, 89, 8700, Termination::convergence, 1.23};
  inspection.initialization = result;
  inspection.truth = std::make_shared<const WindowTruth>();
  Evaluation evaluation;
  evaluation.ate_m = 0.00412;
  evaluation.pne_deg = 0.3149;
  evaluation.pne_aligned_deg = 12.34;
  evaluation.pde_m = 1.2345;
  evaluation.pne_bound_deg = 0.0212;
  inspection.evaluation = evaluation;
  inspection.timing = {123.4, 20.25, 0.2, 3.456, 1.23, 147.3};
  return inspection;
}

Rows rows_of(const Inspection* inspection, bool timings = true) {
  Rows rows;
  for (const ResultGroup& group : result_groups(inspection, timings))
    for (const ResultRow& row : group.rows) rows[row.label] = row;
  return rows;
}

void expect_values(const Rows& rows, const std::map<std::string, std::string>& values) {
  for (const auto& [label, value] : values) EXPECT_EQ(rows.at(label).value, value) << label;
}
void expect_dashes(const Rows& rows, std::initializer_list<const char*> labels, const char* why) {
  for (const char* label : labels) {
    EXPECT_EQ(rows.at(label).value, "\u2013") << label;
    EXPECT_THAT(rows.at(label).tooltip, HasSubstr(why)) << label;
  }
}

TEST(RecordingFacts, DescribeTheRecordingAndNameMissingSensors) {
  Recording recording = desk_recording();
  EXPECT_THAT(
      recording_facts(recording),
      ElementsAre("desk", "640\u00d7480", "60 frames at 30 Hz", "gyro 200 Hz", "ground truth"));
  recording.gyroscope.reset();
  recording.truth.reset();
  recording.timestamps_ns = {0};
  EXPECT_THAT(recording_facts(recording),
              ElementsAre("desk", "640\u00d7480", "1 frame", "no gyro", "no ground truth"));
  recording.board = Board{};
  EXPECT_EQ(recording_facts(recording).back(), "ground truth from the board");
}

TEST(RecordingFacts, OmitUnknownRates) {
  Recording recording = desk_recording();
  recording.gyroscope->timestamps_ns = {0};
  EXPECT_THAT(recording_facts(recording), testing::Contains("gyro"));
}

TEST(Results, CountNoExcludedTracks) {
  Inspection inspection = inspected();
  inspection.settings.exclude = {2};
  EXPECT_EQ(rows_of(&inspection).at("Inliers").value, "2 / 2");
}

TEST(Results, NameTheInlierSelection) {
  Inspection inspection = inspected();
  inspection.settings.options.inliers = Inliers::consistent;
  EXPECT_EQ(rows_of(&inspection).at("Inliers").note, "tracks, per frame: too few are consistent");
  Window window = *inspection.window;
  window.inliers = Inliers::consistent;
  inspection.window = std::make_shared<const Window>(window);
  EXPECT_EQ(rows_of(&inspection).at("Inliers").note, "tracks, consistent");
}

TEST(Results, CountLostTracksApart) {
  Inspection inspection = inspected();
  Window window = *inspection.window;
  window.points_px.emplace_back(window.points_px[0]).col(1).setConstant(NAN);
  inspection.window = std::make_shared<const Window>(window);
  const ResultRow row = rows_of(&inspection).at("Inliers");
  EXPECT_EQ(row.value, "2 / 3");
  EXPECT_EQ(row.note, "tracks, 1 lost");
}

TEST(Results, ShowNoSigmaAsAnAnswerUnlessThereIsOne) {
  Initialization result;
  EXPECT_EQ(shown_normal_sigma(result).text, "");
  result.verdict = Verdict{.readiness = Readiness::ready, .normal_sigma_deg = 0.31};
  EXPECT_EQ(shown_normal_sigma(result).text, "window: normal \u00b10.310\u00b0") << "it failed";
  EXPECT_FALSE(shown_normal_sigma(result).of_result);
  result.ok = true;
  EXPECT_EQ(shown_normal_sigma(result).text, "\u00b10.310\u00b0");
  EXPECT_TRUE(shown_normal_sigma(result).of_result);
  result.verdict->readiness = Readiness::weak;
  EXPECT_TRUE(shown_normal_sigma(result).of_result);
  for (const Readiness readiness : {Readiness::degenerate, Readiness::no_plane}) {
    result.verdict->readiness = readiness;
    EXPECT_FALSE(shown_normal_sigma(result).of_result);
  }
}

TEST(NumberTexts, ShowDashesForWhatIsNotANumber) {
  const double nan = std::nan("");
  for (const double unknown : {nan, -nan, HUGE_VAL}) {
    EXPECT_EQ(number_text(unknown, 3), "\u2013");
    EXPECT_EQ(angle_text(unknown), "\u2013\u00b0");
    EXPECT_EQ(two_decimals(unknown), "\u2013");
    EXPECT_EQ(sigma_text(unknown), "undetermined");
    EXPECT_EQ(uncertain_text(0.5, unknown), "0.500 \u00b1\u2013");
    EXPECT_EQ(uncertain_text(unknown, 0.1), "\u2013 \u00b1\u2013");
  }
}

TEST(Results, ShowTheUncertaintyOfTruthFromTheBoard) {
  Inspection inspection = inspected();
  EXPECT_FALSE(rows_of(&inspection).contains("Truth"));
  auto truth = std::make_shared<WindowTruth>();
  truth->uncertainties = {PoseUncertainty{0.2, 4e-4, 0.06, 0.05}, std::nullopt};
  inspection.truth = truth;
  const ResultRow row = rows_of(&inspection).at("Truth");
  EXPECT_EQ(row.value, "\u00b10.050\u00b0");
  EXPECT_EQ(row.note, "normal");
  EXPECT_THAT(row.tooltip,
              AllOf(HasSubstr("0.4 mm"), HasSubstr("0.06 deg"), HasSubstr("0.05 deg")));
}

TEST(Results, SayThatTruthFromTheBoardLacksTheReadoutTime) {
  Inspection inspection = inspected();
  auto truth = std::make_shared<WindowTruth>();
  truth->source = "chessboard";
  truth->uncertainties = {PoseUncertainty{0.2, 4e-4, 0.06, 0.05}};
  inspection.truth = truth;
  auto recording = std::make_shared<Recording>();
  inspection.recording = recording;
  auto rolling = std::make_shared<Initialization>(*inspection.initialization);
  rolling->row_delay_s = 2e-5;
  inspection.initialization = rolling;
  EXPECT_EQ(rows_of(&inspection).at("Truth").note, "readout unknown");
  EXPECT_THAT(rows_of(&inspection).at("Truth").tooltip, HasSubstr("`calibrate` estimates it"));
  recording->camera.readout = Readout{0.01, 1e-3};
  EXPECT_EQ(rows_of(&inspection).at("Truth").note, "normal");
  truth->estimated_readout = Readout{0.01, 1e-3};
  EXPECT_EQ(rows_of(&inspection).at("Truth").note, "readout estimated");
  EXPECT_THAT(rows_of(&inspection).at("Truth").tooltip, HasSubstr("10.0 +- 1.0 ms"));
}

TEST(Results, HaveUnitsAndSensibleDigits) {
  const Inspection inspection = inspected();
  const Rows rows = rows_of(&inspection);
  expect_values(rows,
                {{"Inliers", "2 / 3"},
                 {"Transfer RMS", "0.43 px"},
                 {"Iterations", "9"},
                 {"PNE", "0.315\u00b0"},
                 {"PNE aligned", "12.3\u00b0"},
                 {"ATE", "4.12 mm"},
                 {"PDE", "1.23 m"},
                 {"Track", "123 ms"},
                 {"Initialize", "3.5 ms"},
                 {"Rotations", "0.20 ms"}});
  EXPECT_EQ(rows.at("Inliers").note, "tracks");
  EXPECT_EQ(rows.at("PNE").note, "bound 0.021\u00b0");
}

TEST(Results, ExplainUnknownValues) {
  for (const auto& [label, row] : rows_of(nullptr)) {
    EXPECT_EQ(row.value, "\u2013") << label;
    EXPECT_THAT(row.tooltip, HasSubstr("nothing has been computed")) << label;
  }
  Inspection inspection = inspected();
  inspection.evaluation.reset();
  inspection.truth.reset();
  expect_dashes(rows_of(&inspection), {"PNE"}, "no ground truth");
  const Inspection plain = made_inspection({.images = false});
  const Rows rows = rows_of(&plain);
  expect_dashes(rows, {"Rotation alone", "Baseline |t|", "Normal", "Distance ratio"}, "Unknown");
  EXPECT_FALSE(rows.contains("Bias x"));
}

TEST(Results, ExplainADegenerateAlignment) {
  Inspection inspection = inspected();
  inspection.evaluation->alignment = Alignment::point;
  inspection.evaluation->ate_m.reset();
  inspection.evaluation->pde_m.reset();
  inspection.evaluation->pne_aligned_deg.reset();
  expect_dashes(rows_of(&inspection), {"ATE", "PDE", "PNE aligned"}, "path is a point");
  EXPECT_EQ(rows_of(&inspection).at("PNE").value, "0.315\u00b0");
  inspection.evaluation->alignment = Alignment::line;
  expect_dashes(rows_of(&inspection), {"PNE aligned"}, "path is a line");
}

TEST(Results, ShowErrorsThatContradictTheTruthInRed) {
  Inspection inspection = inspected();
  inspection.evaluation->path_error_m = 0.0123;
  inspection.evaluation->path_error_percent = 4.56;
  inspection.evaluation->scale_ratio = 0.987;
  const Rows fitting = rows_of(&inspection);
  expect_values(fitting, {{"Path error", "12.3 mm"}, {"Scale ratio", "0.9870"}});
  EXPECT_EQ(fitting.at("Path error").note, "4.6 % of the path");
  EXPECT_TRUE(fitting.at("PNE").color == Role::text);
  inspection.evaluation->pne_sigmas = 48;
  const Rows off = rows_of(&inspection);
  for (const char* label : {"PNE", "PDE", "Path error", "Scale ratio"})
    EXPECT_TRUE(off.at(label).color == Role::bad) << label;
}

TEST(Results, SayWhyATruthIsNotUsed) {
  Inspection inspection = inspected();
  inspection.evaluation = Evaluation{.plane = 1};
  expect_dashes(rows_of(&inspection), {"PNE", "PDE", "Path error"}, "describes another plane");
  inspection.truth_convention = TruthConvention{.name = "its quaternions are read w first"};
  expect_dashes(rows_of(&inspection), {"PNE", "ATE", "Scale ratio"}, "are read w first");
}

TEST(Results, ShowTheReasonOfAFailure) {
  Inspection inspection = inspected();
  inspection.evaluation.reset();
  inspection.initialization =
      std::make_shared<const Initialization>(failed("no parallax: the camera only rotated"));
  const Rows rows = rows_of(&inspection);
  expect_dashes(rows, {"Transfer RMS", "ATE"}, "initialization failed");
}

TEST(Results, SplitValuesFromTheirUncertainties) {
  using testing::Pair;
  EXPECT_THAT(value_and_uncertainty("0.912 ±0.004 rad/s"), Pair("0.912", "±0.004 rad/s"));
  EXPECT_THAT(value_and_uncertainty("±0.31°"), Pair("", "±0.31°"));
  EXPECT_THAT(value_and_uncertainty("12.0 ms"), Pair("12.0 ms", ""));
}

TEST(Results, GroupsWithoutValuesSayWhy) {
  const ResultGroup unknown{"TRUTH", {dash("PNE", "no truth"), dash("ATE", "no truth")}};
  EXPECT_FALSE(has_values(unknown));
  EXPECT_EQ(why_no_values(unknown), "TRUTH: no truth");
  const ResultGroup mixed{"TRUTH", {dash("PNE", "a point"), dash("ATE", "a line")}};
  EXPECT_EQ(why_no_values(mixed), "TRUTH: \n  PNE: a point\n  ATE: a line");
  EXPECT_TRUE(has_values({"TRUTH", {dash("PNE", "no truth"), {.label = "ATE", .value = "1 mm"}}}));
}

TEST(Results, OmitTimesInScreenshots) {
  const Inspection inspection = inspected();
  expect_dashes(rows_of(&inspection, false),
                {"Track", "RANSAC", "Rotations", "Initialize", "Solver", "Total"},
                "Screenshots omit times");
}

TEST(UncertaintyFacts, HaveUnitsAndTheRotationModel) {
  const Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  const Rows rows = rows_of(&inspection);
  expect_values(rows,
                {{"Rotation alone", "8.80 px"},
                 {"Baseline |t|", "0.450 d"},
                 {"Normal", "\u00b10.310\u00b0"},
                 {"Distance ratio", "0.9978 \u00b10.0013"},
                 {"Bias x", "0.01230 \u00b10.00050 rad/s"},
                 {"Bound, known R", "0.186\u00b0"},
                 {"Bound, free bias", "0.279\u00b0"}});
  EXPECT_EQ(rows.at("Rotation alone").note, "noise 0.40 px");
  EXPECT_EQ(rows.at("Normal").note, "gyro bias unknown");
  for (const char* label : {"Bound, known R", "Bound, free bias"})
    EXPECT_THAT(rows.at(label).tooltip, HasSubstr("degrees"));
}

TEST(UncertaintyFacts, AreUndeterminedBeyondARightAngle) {
  const Inspection inspection = made_inspection({.normal_sigma_deg = 120});
  const auto groups = result_groups(&inspection, false, 0);
  const auto uncertainty = std::ranges::find(groups, "UNCERTAINTY", &ResultGroup::title);
  ASSERT_NE(uncertainty, groups.end());
  EXPECT_EQ(uncertainty->rows.front().value, "undetermined");
  EXPECT_EQ(compared_columns().back().text(120), "undetermined");
  EXPECT_EQ(compared_columns().back().text(0.5), angle_text(0.5));
  const std::string text = to_text(inspection);
  EXPECT_THAT(text, AllOf(HasSubstr("normal undetermined"), Not(HasSubstr("120."))));
  EXPECT_THAT(numbers_table(inspection), HasSubstr(">undetermined<"));
  ScannedStart start{.start = 3, .ok = true, .sigma_deg = 120};
  EXPECT_THAT(to_text(start), HasSubstr(", normal undetermined"));
  start.sigma_deg = 0.5;
  EXPECT_THAT(to_text(start), HasSubstr(", normal +- 0.5 deg"));
  EXPECT_EQ(to_json(inspection)["uncertainty"]["normal_sigma_deg"], 120);
}

TEST(UncertaintyFacts, ShowTheSecondNumberOfATypicalCalibration) {
  Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  auto result = std::make_shared<Initialization>(*inspection.initialization);
  result->uncertainty->typical_lens_sigma_deg = 0.62;
  inspection.initialization = result;
  const Rows rows = rows_of(&inspection);
  EXPECT_EQ(rows.at("Normal").value, "\u00b10.310\u00b0");
  EXPECT_EQ(rows.at("Normal").note, "lens exact, \u00b10.620\u00b0 typical");
  EXPECT_THAT(rows.at("Normal").tooltip, HasSubstr("gyro bias unknown"));
  EXPECT_EQ(normal_sigma_deg(inspection), 0.62);
  inspection.settings.options.lens = Lens::exact;
  EXPECT_EQ(normal_sigma_deg(inspection), 0.31);
}

TEST(TimeLine, ShowsComparableVerdictsWhereThereAreAny) {
  Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  inspection.comparable_growth = inspection.growth;
  for (Verdict& verdict : inspection.comparable_growth) verdict.readiness = Readiness::weak;
  EXPECT_THAT(bar_text(inspection, 30),
              AllOf(HasSubstr("weak"), HasSubstr("at least as wide as the whole window's")));
}

TEST(TimeLine, CountsLostTracksApart) {
  Inspection inspection = made_inspection({.images = false});
  const Window& window = *inspection.window;
  ASSERT_GT(lost_count(window, 25), 10);
  EXPECT_THAT(
      bar_text(inspection, 30),
      HasSubstr(fmt::format(
          "frame 30: {} inliers, {} lost", window.inlier_count(25), lost_count(window, 25))));
  EXPECT_THAT(bar_text(inspection, 5), Not(HasSubstr("lost")));
}

TEST(TimeLine, OmitsAnUnknownParallax) {
  Inspection inspection = made_inspection({.images = false});
  inspection.motion.assign(30, {.parallax_px = 3.25, .rotation_rate_deg_s = 40});
  inspection.motion[2].parallax_px = std::nan("");
  EXPECT_THAT(bar_text(inspection, 6), HasSubstr("\nparallax 3.2 px, angular rate 40"));
  EXPECT_THAT(bar_text(inspection, 7), HasSubstr("\nangular rate 40"));
}

TEST(TimeLine, ShowsTheVerdictOnTheWindowThatEndsAtABar) {
  const Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  const auto text = [&](int frame) { return bar_text(inspection, frame); };
  for (const int outside : {4, 35}) EXPECT_EQ(text(outside), "frame " + std::to_string(outside));
  EXPECT_THAT(text(5), AllOf(HasSubstr("inliers. Reference frame"), Not(HasSubstr("ready"))));
  for (const auto& [frame, verdict] :
       {std::pair{6, "window of 2 frames, 5 to 6: degenerate, normal"},
        {14, "window of 10 frames, 5 to 14: weak, normal"},
        {34, "window of 30 frames, 5 to 34: ready, normal"}})
    EXPECT_THAT(text(frame), HasSubstr(verdict));
  EXPECT_THAT(text(14), HasSubstr("given rotations"));
  EXPECT_THAT(text(34),
              HasSubstr("normal \u00b1" +
                        angle_text(*inspection.initialization->verdict->normal_sigma_deg)))
      << "the number of the result";
  EXPECT_THAT(text(34), Not(HasSubstr("given rotations")));
}

TEST(Numbers, HaveThreeSignificantDigitsOrThoseOfTheirUncertainty) {
  EXPECT_EQ(length_text(0.000123), "0.12 mm");
  EXPECT_EQ(length_text(0.01234), "12.3 mm");
  EXPECT_EQ(length_text(0.5), "500 mm");
  EXPECT_EQ(length_text(-0.0000001), "0.00 mm");
  EXPECT_EQ(length_text(-0.0001), "-0.10 mm");
  EXPECT_EQ(length_text(12.345), "12.3 m");
  EXPECT_EQ(angle_text(0.00123), "0.001\u00b0");
  EXPECT_EQ(angle_text(178.6), "179\u00b0");
  EXPECT_EQ(milliseconds_text(1234.5), "1234 ms");
  EXPECT_EQ(uncertain_text(0.91234, 0.0042), "0.9123 \u00b10.0042");
  EXPECT_EQ(uncertain_text(12.34, 3.2), "12.3 \u00b13.2");
  EXPECT_EQ(uncertain_text(123.4, 32), "123 \u00b132");
  EXPECT_EQ(uncertain_text(0.5, 1e-9), "0.500000 \u00b10.000000");
}

TEST(Results, CountIterationsOfDiscardedAttemptsApart) {
  SolverReport solver{.iterations = 110, .trace = std::vector<SolverStep>(43)};
  EXPECT_EQ(iterations_text(solver), "42 of 110");
  solver.iterations = 43;  // Ceres counts the start
  EXPECT_EQ(iterations_text(solver), "43");
  EXPECT_EQ(iterations_text({.iterations = 7}), "7");
}

HomographyCandidate decomposition(double tilt_deg, const std::string& rejected = "") {
  const double tilt = radians(tilt_deg);
  const Eigen::Vector3d normal(0, -std::sin(tilt), -std::cos(tilt));
  return {.frame = 5,
          .motion = {so3_exp({0, 0.1, 0}), {0.3, 0, 0.4}, normal},
          .score = 0.25,
          .rejection = rejected.empty() ? Rejection::none : Rejection::behind_camera,
          .rejected = rejected,
          .behind = 2,
          .of = 80};
}

TEST(CandidateFacts, CountFeasibleDecompositionsAndFormatNumbers) {
  const HomographyCandidate first = decomposition(10), second = decomposition(44);
  const HomographyCandidate rejected = decomposition(3, "behind");
  EXPECT_THAT(candidates_sentence(std::vector{first, second, rejected}),
              AllOf(HasSubstr("2 of 3"), HasSubstr("34.0\u00b0")));
  EXPECT_THAT(candidates_sentence(std::vector{rejected, second}),
              AllOf(HasSubstr("1 of 2"), HasSubstr("44.0\u00b0")));
  EXPECT_THAT(candidates_sentence(std::vector{rejected}), HasSubstr("none of 1 decomposition "));
  EXPECT_THAT(candidate_cells(decomposition(30)),
              ElementsAre("0.000, -0.500, -0.866", "30.0", "5.73", "0.500", "0.25", "2 of 80"));
}

TEST(CandidateFacts, ExplainMissingDecompositions) {
  NormalStudy study;
  study.candidates = {{}, {decomposition(10)}, {}};
  EXPECT_EQ(why_no_candidates(study, 1), "");
  for (const auto& [frame, why] :
       {std::pair{0, "reference frame"}, {2, "no homography"}, {-1, "outside"}, {3, "outside"}})
    EXPECT_THAT(why_no_candidates(study, frame), HasSubstr(why)) << frame;
}

TEST(StudyFacts, ExplainAMissingStudy) {
  WorkbenchState state;
  NormalStudy study;
  const auto why = [&] { return why_no_study(state, "computing"); };
  const auto use_study = [&] { state.results.study = std::make_shared<const NormalStudy>(study); };
  EXPECT_EQ(why(), "computing");
  Inspection inspection;
  inspection.window = study.window = std::make_shared<const Window>();
  state.results.inspection = std::make_shared<const Inspection>(inspection);
  EXPECT_EQ(why(), "computing");
  use_study();
  EXPECT_EQ(why(), "");
  study.error = "no memory";
  use_study();
  EXPECT_THAT(why(), HasSubstr("no memory"));
  study.window = std::make_shared<const Window>();
  use_study();
  EXPECT_EQ(why(), "computing") << "the study of another window";
}

}  // namespace
}  // namespace gpo
