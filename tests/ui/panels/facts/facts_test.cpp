// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/facts.h"

#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "ui/look/numbers.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::int64_t> times(int count, double rate_hz) {
  std::vector<std::int64_t> all;
  all.reserve(count);
  for (int i = 0; i < count; ++i) all.push_back(static_cast<std::int64_t>(i * 1e9 / rate_hz));
  return all;
}

Recording desk() {
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
  inspection.recording = std::make_shared<const Recording>(desk());
  auto window = std::make_shared<Window>();
  window->points_px = {Eigen::Matrix2Xd::Zero(2, 3)};
  window->inlier = {{true, true, false}};
  inspection.window = window;
  auto result = std::make_shared<Initialization>();
  result->ok = true;
  result->rms_px = 0.4321;
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

std::map<std::string, ResultRow> rows_of(const Inspection* inspection, bool timings = true) {
  std::map<std::string, ResultRow> rows;
  for (const ResultGroup& group : result_groups(inspection, timings)) {
    for (const ResultRow& row : group.rows) rows[row.label] = row;
  }
  return rows;
}

TEST(RecordingFacts, NameSizeFramesRateGyroAndTruth) {
  EXPECT_THAT(recording_facts(desk()),
              ElementsAre("desk", "640\u00d7480", "60 frames at 30 Hz", "gyro 200 Hz", "truth"));
}

TEST(RecordingFacts, SayWhatIsMissing) {
  Recording recording = desk();
  recording.gyroscope.reset();
  recording.truth.reset();
  recording.timestamps_ns = {0};
  EXPECT_THAT(recording_facts(recording),
              ElementsAre("desk", "640\u00d7480", "1 frames", "no gyro", "no truth"));
  recording.board = Board{};
  EXPECT_EQ(recording_facts(recording).back(), "truth from the board");
}

TEST(Results, SayHowInliersWereTold) {
  Inspection inspection = inspected();
  inspection.settings.options.inliers = Inliers::consistent;
  EXPECT_EQ(rows_of(&inspection).at("Inliers").note, "tracks, per frame: too few are consistent");
  Window window = *inspection.window;
  window.inliers = Inliers::consistent;
  inspection.window = std::make_shared<const Window>(window);
  EXPECT_EQ(rows_of(&inspection).at("Inliers").note, "tracks, consistent");
}

TEST(Results, SayHowSureATruthFromTheBoardIs) {
  Inspection inspection = inspected();
  EXPECT_FALSE(rows_of(&inspection).contains("Truth"));
  WindowTruth truth;
  truth.uncertainties = {PoseUncertainty{0.2, 4e-4, 0.06, 0.05}, std::nullopt};
  inspection.truth = std::make_shared<const WindowTruth>(truth);
  const ResultRow row = rows_of(&inspection).at("Truth");
  EXPECT_EQ(row.value, "\u00b10.050\u00b0");
  EXPECT_THAT(row.tooltip, HasSubstr("certain to 0.4 mm, 0.06 deg, board normal 0.05 deg"));
}

TEST(Results, CarryUnitsAndSensibleDigits) {
  const Inspection inspection = inspected();
  const auto rows = rows_of(&inspection);
  EXPECT_EQ(rows.at("Status").value, "ok");
  EXPECT_EQ(rows.at("Inliers").value, "2 / 3");
  EXPECT_EQ(rows.at("Inliers").note, "tracks");
  EXPECT_EQ(rows.at("RMS").value, "0.43 px");
  EXPECT_EQ(rows.at("Iterations").value, "9");
  EXPECT_EQ(rows.at("PNE").value, "0.315\u00b0");
  EXPECT_EQ(rows.at("PNE").note, "bound 0.021\u00b0");
  EXPECT_EQ(rows.at("PNE aligned").value, "12.3\u00b0");
  EXPECT_EQ(rows.at("ATE").value, "4.12 mm");
  EXPECT_EQ(rows.at("PDE").value, "1.23 m");
  EXPECT_EQ(rows.at("Track").value, "123 ms");
  EXPECT_EQ(rows.at("Initialize").value, "3.5 ms");
  EXPECT_EQ(rows.at("Rotations").value, "0.20 ms");
}

TEST(Results, UnknownIsADashThatSaysWhy) {
  for (const auto& [label, row] : rows_of(nullptr)) {
    EXPECT_EQ(row.value, "\u2013") << label;
    EXPECT_THAT(row.tooltip, HasSubstr("nothing has been computed")) << label;
  }
  Inspection inspection = inspected();
  inspection.evaluation.reset();
  inspection.truth.reset();
  EXPECT_EQ(rows_of(&inspection).at("PNE").value, "\u2013");
  EXPECT_THAT(rows_of(&inspection).at("PNE").tooltip, HasSubstr("no ground truth"));
}

TEST(Results, DegenerateAlignmentIsADashThatSaysWhy) {
  Inspection inspection = inspected();
  inspection.evaluation->alignment = Alignment::point;
  inspection.evaluation->ate_m.reset();
  inspection.evaluation->pde_m.reset();
  inspection.evaluation->pne_aligned_deg.reset();
  const auto rows = rows_of(&inspection);
  for (const char* label : {"ATE", "PDE", "PNE aligned"}) {
    EXPECT_EQ(rows.at(label).value, "\u2013");
    EXPECT_THAT(rows.at(label).tooltip, HasSubstr("path is a point"));
  }
  EXPECT_EQ(rows.at("PNE").value, "0.315\u00b0");
  inspection.evaluation->alignment = Alignment::line;
  EXPECT_THAT(rows_of(&inspection).at("PNE aligned").tooltip, HasSubstr("path is a line"));
}

TEST(Results, FailureShowsItsReason) {
  Inspection inspection = inspected();
  inspection.evaluation.reset();
  inspection.initialization =
      std::make_shared<const Initialization>(failed("no parallax: the camera only turned"));
  const auto rows = rows_of(&inspection);
  EXPECT_EQ(rows.at("Status").value, "failed");
  EXPECT_EQ(rows.at("Status").tone, Tone::bad);
  EXPECT_THAT(rows.at("Status").tooltip, HasSubstr("no parallax"));
  EXPECT_EQ(rows.at("RMS").value, "\u2013");
  EXPECT_THAT(rows.at("ATE").tooltip, HasSubstr("initialization failed"));
}

TEST(Results, ImagesLeaveTimingsOutAndSayWhy) {
  const Inspection inspection = inspected();
  const auto rows = rows_of(&inspection, false);
  for (const char* label : {"Track", "RANSAC", "Rotations", "Initialize", "Solver", "Total"}) {
    EXPECT_EQ(rows.at(label).value, "\u2013");
    EXPECT_THAT(rows.at(label).tooltip, HasSubstr("left out of pictures"));
  }
}

TEST(Numbers, KeepThreeDigitsThatMeanSomething) {
  EXPECT_EQ(length_text(0.000123), "0.12 mm");
  EXPECT_EQ(length_text(0.01234), "12.3 mm");
  EXPECT_EQ(length_text(0.5), "500 mm");
  EXPECT_EQ(length_text(12.345), "12.3 m");
  EXPECT_EQ(angle_text(0.00123), "0.001\u00b0");
  EXPECT_EQ(angle_text(178.6), "179\u00b0");
  EXPECT_EQ(milliseconds_text(1234.5), "1234 ms");
}

TEST(Numbers, ErrorsTellHowManyDigitsMeanSomething) {
  EXPECT_EQ(uncertain_text(0.91234, 0.0042), "0.9123 \u00b10.0042");
  EXPECT_EQ(uncertain_text(12.34, 3.2), "12.3 \u00b13.2");
  EXPECT_EQ(uncertain_text(123.4, 32), "123 \u00b132");
  EXPECT_EQ(uncertain_text(0.5, 1e-9), "0.500000 \u00b10.000000");
}

}  // namespace
}  // namespace gpo
