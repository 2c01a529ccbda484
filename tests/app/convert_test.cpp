// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"

#include <cmath>
#include <sstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

void expect_same_result(const fs::path& recording, const std::string& arguments) {
  const fs::path converted = fresh_folder() / "euroc";
  succeeding("convert {} --output {}", recording, converted);
  json before = run_json("{} {}", recording, arguments);
  json after = run_json("{} {}", converted, arguments);
  for (const char* key : {"recording", "timing_ms", "truth"}) {
    before.erase(key);
    after.erase(key);
  }
  expect_same_json(before, after, 1e-6, "");
}

TEST(Convert, KeepsTheResultOfTheDesk) { expect_same_result(desk(), "--frames 20"); }

TEST(Convert, KeepsTheResultOfRealTracks) {
  SKIP_WITHOUT(shared("cards-tracks"));
  expect_same_result(shared("cards-tracks"), "--start 58 --frames 15 --method ba");
}

TEST(Convert, KeepsTheReadoutTime) {
  const fs::path folder = fresh_folder();
  const fs::path camera = "mav0/cam0/sensor.yaml";
  fs::copy(desk(), folder / "given", fs::copy_options::recursive);
  write_file(folder / "given" / camera,
             read_file(folder / "given" / camera) +
                 "readout_direction: left\nreadout_s: 0.012\nreadout_sigma_s: 0.001\n");
  succeeding("convert {} --output {}", folder / "given", folder / "made");
  EXPECT_THAT(read_file(folder / "made" / camera),
              AllOf(HasSubstr("readout_direction: left"),
                    HasSubstr("readout_s: 0.012"),
                    HasSubstr("readout_sigma_s: 0.001")));
  EXPECT_THAT(succeeding("info {}", folder / "made").out, HasSubstr("12.00 ms, last column first"));
  EXPECT_THAT(succeeding("info {}", desk()).out, ContainsRegex("readout +unknown"));
}

TEST(Convert, RefusesAnExistingFolder) {
  expect_each_refused("convert " + kDesk,
                      {{" --output {}/..", "is not empty; choose a new or empty folder"}});
}

std::vector<std::vector<double>> rows_of(const fs::path& file) {
  std::vector<std::vector<double>> rows;
  for (std::string line : split(read_file(file), '\n')) {
    if (line.starts_with('#')) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream cells(line);
    rows.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
  }
  return rows;
}

/// ATE as evo computes it from two trajectories: RMS after a similarity by Umeyama's method.
double ate_m(const std::vector<std::vector<double>>& truth,
             const std::vector<std::vector<double>>& estimate) {
  const auto n = static_cast<Eigen::Index>(truth.size());
  Eigen::Matrix3Xd a(3, n), b(3, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.col(i) << estimate[i][1], estimate[i][2], estimate[i][3];
    b.col(i) << truth[i][1], truth[i][2], truth[i][3];
  }
  const Eigen::Matrix4d T = Eigen::umeyama(a, b, true);
  const Eigen::Matrix3Xd error =
      (T.topLeftCorner<3, 3>() * a).colwise() + T.topRightCorner<3, 1>() - b;
  return std::sqrt(error.colwise().squaredNorm().mean());
}

TEST(Trajectories, AreReadableByEvo) {
  const fs::path folder = fresh_folder();
  const auto write = [&](const std::string& format) {
    const fs::path file = folder / format;
    const std::string run = "run sequences/desk --trajectory-format " + format;
    succeeding("{0} --trajectory {1} --true-trajectory {1}-truth --json {1}.json", run, file);
    return std::pair(rows_of(file), rows_of(folder / (format + "-truth")));
  };
  const auto [tum, tum_truth] = write("tum");
  const auto [euroc, euroc_truth] = write("euroc");
  const auto [kitti, kitti_truth] = write("kitti");
  for (const auto& rows : {tum, euroc, kitti, kitti_truth}) ASSERT_EQ(rows.size(), 30U);
  for (int i = 0; i < 30; ++i) {
    ASSERT_EQ(tum[i].size(), 8U);
    ASSERT_EQ(euroc[i].size(), 8U);
    ASSERT_EQ(kitti[i].size(), 12U);
    EXPECT_NEAR(euroc[i][0] * 1e-9, tum[i][0], 1e-6);
    const Eigen::Quaterniond q(tum[i][7], tum[i][4], tum[i][5], tum[i][6]);
    EXPECT_NEAR(q.norm(), 1, 1e-8);
    const Eigen::Matrix3d R = q.normalized().matrix();
    for (int row = 0; row < 3; ++row) {
      EXPECT_NEAR(kitti[i][4 * row + 3], tum[i][1 + row], 1e-8);
      EXPECT_NEAR(euroc[i][1 + row], tum[i][1 + row], 1e-12);
      for (int column = 0; column < 3; ++column)
        EXPECT_NEAR(kitti[i][4 * row + column], R(row, column), 1e-7);
    }
    EXPECT_EQ(euroc[i][4], tum[i][7]);  // w first, w last
    EXPECT_EQ(euroc[i][5], tum[i][4]);
  }
  const json metrics = read_json(folder / "tum.json")["metrics"];
  EXPECT_NEAR(ate_m(tum_truth, tum), metrics["ate_m"], 1e-6);
}

TEST(Trajectories, RefuseTrueTrajectoryWithoutTruth) {
  const fs::path folder = fresh_folder();
  copy_of_desk(folder / "desk", {"mav0/state_groundtruth_estimate0", "board.yaml"});
  const Outcome outcome = program("run {0}/desk --true-trajectory {0}/truth.txt", folder);
  expect_exit(2, outcome, "desk: no ground truth");
  EXPECT_FALSE(fs::exists(folder / "truth.txt"));
}

TEST(Trajectories, TruthWithoutAPlaneGivesTheAte) {
  const fs::path copy = copy_of_desk(fresh_folder() / "desk", {"plane.yaml", "board.yaml"});
  const json whole = run_json(kDesk)["metrics"], without = run_json(copy.string())["metrics"];
  EXPECT_EQ(without["ate_m"], whole["ate_m"]);
  EXPECT_TRUE(without["pne_deg"].is_null());
}

}  // namespace
}  // namespace gpo::test
