// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/desk.h"
#include "tests/engine/test_folder.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <tuple>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d, testing::ElementsAre, testing::IsEmpty;

/// A hand that starts and stops, at 200 Hz.
struct Path {
  std::vector<std::int64_t> times_ns;
  std::vector<std::optional<Pose>> poses;
};

Path made_path() {
  Path path;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.005 * i;
    const double moved = t < 0.3 ? 0 : 1 - std::cos(12 * (t - 0.3));
    path.times_ns.push_back(7'000'000'000 + 5'000'000 * i);
    path.poses.push_back(
        Pose{so3_exp(moved * Vector3d(0.1, 0.9, 0.2)), moved * Vector3d(0.3, 0, 0)});
  }
  return path;
}

TEST(TruthJumps, AreNotFoundInFastMotionFromRestNorAcrossAGap) {
  Path path = made_path();
  EXPECT_THAT(jumps_of(path.times_ns, path.poses), IsEmpty());
  for (int i = 80; i < 110; ++i) path.poses[i].reset();
  EXPECT_THAT(jumps_of(path.times_ns, path.poses), IsEmpty());
  EXPECT_THAT(desk()->truth->jumps, IsEmpty());
}

TEST(TruthJumps, AreAWrongPoseOrAStepAndNameTheirSize) {
  Path path = made_path();
  path.poses[121]->R_wc = path.poses[121]->R_wc * so3_exp({0, 0, radians(87)});
  for (int i = 161; i < 200; ++i) path.poses[i]->p_wc.y() += 0.04;
  const auto jumps = jumps_of(path.times_ns, path.poses);
  EXPECT_THAT(notes_of(jumps, path.times_ns.front()),
              ElementsAre(testing::StartsWith("ground truth jumps at 0.60 s: 8"),
                          testing::StartsWith("ground truth jumps at 0.80 s: 4")));
  EXPECT_THAT(text_of(jumps[0], 0), testing::EndsWith(" deg within 5 ms"));
  EXPECT_THAT(text_of(jumps[1], 0), testing::EndsWith(" mm within 5 ms"));
}

TEST(Truth, IsInterpolatedTheShortWayBetweenQuaternionsOfEitherSign) {
  const TestFolder folder;
  const auto file =
      folder.write("groundtruth.txt",
                   "0 0 0 0 0 0 0.1 0.995\n0.1 0 0 0 0 0 -0.2 -0.98\n0.2 0 0 0 0 0 0.3 0.954\n");
  const PosePath path = read_tum_path(file);
  const std::vector<std::int64_t> frames{0, 50'000'000, 150'000'000, 200'000'000};
  const GroundTruth truth = camera_truth(path, {}, "", frames);
  EXPECT_THAT(truth.jumps, IsEmpty());
  for (std::size_t i = 1; i < frames.size(); ++i)
    EXPECT_LT(so3_log(truth.poses[i - 1]->R_wc.transpose() * truth.poses[i]->R_wc).norm(), 0.25);
}

/// Copies the example recording and rotates one pose of its ground truth.
fs::path desk_with_jump(const TestFolder& folder) {
  const fs::path copy = folder.path() / "desk";
  fs::copy(desk()->path, copy, fs::copy_options::recursive);
  const fs::path file = "mav0/state_groundtruth_estimate0/data.csv";
  std::ifstream from(desk()->path / file);
  std::string text, line;
  for (int i = 0; std::getline(from, line); ++i) {
    if (i == 20) {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      std::swap(cells[4], cells[5]);
      line = fmt::format("{}", fmt::join(cells, ","));
    }
    text += line + "\n";
  }
  std::ofstream(copy / file) << text;
  return copy;
}

TEST(TruthJumps, AreReportedByInfoAndResultsOfWindowsThatContainThem) {
  const TestFolder folder;
  const auto recording = open_recording(desk_with_jump(folder));
  ASSERT_EQ(recording->truth->jumps.size(), 1U);
  const std::string text = "ground truth jumps at 0.60 s";
  EXPECT_THAT(to_text(describe(*recording)), testing::HasSubstr(text));
  Inspector inspector(recording);
  for (const auto& [start, frames, notes] : {std::tuple(0, 30, 1U), {30, 20, 0U}}) {
    Settings settings;
    settings.start = start;
    settings.frames = frames;
    const auto inspection = inspector.inspect(settings);
    EXPECT_EQ(notes_of(*inspection).size(), notes) << start;
    EXPECT_EQ(to_json(*inspection).contains("notes"), notes > 0);
    EXPECT_EQ(to_text(*inspection).find(text) != std::string::npos, notes > 0);
  }
}

TEST(Notes, NameARequestedPlaneThatDoesNotExist) {
  Inspector inspector(desk());
  Settings settings;
  settings.options.plane = 9;
  const auto inspection = inspector.inspect(settings);
  EXPECT_THAT(notes_of(*inspection),
              testing::UnorderedElementsAre(
                  testing::StartsWith("the ground truth describes plane 1 of the window"),
                  testing::StartsWith("plane 9 does not exist: the window has ")));
}

std::vector<std::string> notes_with_truth(Inspection inspection) {
  inspection.findings.clear();
  add_findings(inspection);
  return notes_of(inspection);
}

TEST(Notes, SayThatTheTruthOfABoardIgnoresARollingShutter) {
  const auto recording = std::make_shared<Recording>(*desk());
  Inspection inspection = *Inspector(recording).inspect({});
  WindowTruth truth = *inspection.truth;
  truth.uncertainties.resize(truth.cameras.size());
  Initialization rolling = *inspection.initialization;
  rolling.row_delay_s = 5e-5;
  inspection.truth = std::make_shared<const WindowTruth>(truth);
  EXPECT_THAT(notes_with_truth(inspection), testing::IsEmpty());
  inspection.initialization = std::make_shared<const Initialization>(rolling);
  EXPECT_THAT(
      notes_with_truth(inspection),
      ElementsAre(testing::StartsWith("the tracks show a rolling shutter, but the ground")));
  recording->camera.readout = Readout{0.02, 1e-3};
  EXPECT_THAT(notes_with_truth(inspection), testing::IsEmpty());
}

}  // namespace
}  // namespace gpo::test
