// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/tracks.h"
#include "tests/app/program.h"

#include <cmath>
#include <sstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::BadInput;
using test::desk;
using test::fresh_folder;
using test::Outcome;
using test::program;
using test::read_file;
using ::testing::HasSubstr;

/// Numbers to a relative 1e-6, as rotations go through quaternions; everything else exactly.
void expect_same(const json& a, const json& b, const std::string& where) {
  if (a.is_number_float() || b.is_number_float()) {
    EXPECT_NEAR(a.get<double>(), b.get<double>(), 1e-6 * (1 + std::abs(a.get<double>()))) << where;
    return;
  }
  ASSERT_EQ(a.type(), b.type()) << where;
  if (!a.is_structured()) {
    EXPECT_EQ(a, b) << where;
    return;
  }
  ASSERT_EQ(a.size(), b.size()) << where;
  for (auto item = a.items().begin(); item != a.items().end(); ++item)
    expect_same(item.value(),
                a.is_object() ? b.at(item.key()) : b.at(std::stoul(item.key())),
                where + "." + item.key());
}

json result_of(const fs::path& recording, const std::string& arguments, const fs::path& file) {
  const Outcome outcome =
      program("run " + recording.string() + " " + arguments + " --json " + file.string());
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  json result = json::parse(read_file(file));
  for (const char* key : {"recording", "timing_ms", "truth"}) result.erase(key);
  return result;
}

void expect_same_result(const fs::path& recording, const std::string& arguments) {
  const fs::path folder = fresh_folder();
  const Outcome outcome =
      program("convert " + recording.string() + " --output " + (folder / "euroc").string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  expect_same(result_of(recording, arguments, folder / "a.json"),
              result_of(folder / "euroc", arguments, folder / "b.json"),
              "");
}

TEST(Convert, RunGivesTheResultOfTheOriginal) { expect_same_result(desk(), "--frames 20"); }

TEST(Convert, RunGivesTheResultOfRealTracks) {
  const fs::path cards = fs::path(GPO_SHARED_DIR) / "data" / "cards-tracks";
  if (!fs::exists(cards)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  expect_same_result(cards, "--start 58 --frames 15 --method ba");
}

TEST(Convert, RefusesWhatWouldBeLost) {
  const fs::path folder = fresh_folder();
  const BadInput bad{"convert " + desk().string() + " --output " + folder.parent_path().string(),
                     "is not empty; choose a new or empty folder"};
  test::expect_refused(program(bad.arguments), bad, folder);
}

std::vector<std::vector<double>> rows_of(const fs::path& file) {
  std::istringstream text(read_file(file));
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(text, line);) {
    if (line.starts_with('#')) continue;
    std::ranges::replace(line, ',', ' ');
    std::istringstream cells(line);
    rows.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
  }
  return rows;
}

/// What evo does with the two files: similarity by Umeyama's method, root mean square.
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

TEST(Trajectories, AreWhatEvoReads) {
  const fs::path folder = fresh_folder();
  const auto write = [&](const std::string& format) {
    const std::string in = (folder / format).string();
    const Outcome outcome =
        program("run " + desk().string() + " --trajectory-format " + format + " --trajectory " +
                in + " --true-trajectory " + in + "-truth --json " + in + ".json");
    EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
    return std::pair(rows_of(in), rows_of(in + "-truth"));
  };
  const auto [tum, tum_truth] = write("tum");
  const auto [euroc, euroc_truth] = write("euroc");
  const auto [kitti, kitti_truth] = write("kitti");
  ASSERT_EQ(tum.size(), 30U);
  ASSERT_EQ(euroc.size(), 30U);
  ASSERT_EQ(kitti.size(), 30U);
  ASSERT_EQ(kitti_truth.size(), 30U);
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
  const json metrics = json::parse(read_file(folder / "tum.json"))["metrics"];
  EXPECT_NEAR(ate_m(tum_truth, tum), metrics["ate_m"], 1e-6);
}

TEST(Trajectories, SayWhereThereIsNoTruth) {
  const fs::path folder = fresh_folder();
  const fs::path copy = folder / "desk";
  fs::copy(desk(), copy, fs::copy_options::recursive);
  fs::remove_all(copy / "mav0/state_groundtruth_estimate0");
  fs::remove(copy / "board.yaml");
  const Outcome outcome =
      program("run " + copy.string() + " --true-trajectory " + (folder / "truth.txt").string());
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("desk: found no ground truth, expected one"));
  EXPECT_FALSE(fs::exists(folder / "truth.txt"));
}

/// A path without a plane is measured as far as it goes.
TEST(Trajectories, OfTheTruthWithoutAPlaneGiveTheAte) {
  const fs::path folder = fresh_folder();
  const fs::path copy = folder / "desk";
  fs::copy(desk(), copy, fs::copy_options::recursive);
  fs::remove(copy / "plane.yaml");
  fs::remove(copy / "board.yaml");
  const json whole = result_of(desk(), "", folder / "a.json")["metrics"];
  const json without = result_of(copy, "", folder / "b.json")["metrics"];
  EXPECT_EQ(without["ate_m"], whole["ate_m"]);
  EXPECT_TRUE(without["pne_deg"].is_null());
}

}  // namespace
}  // namespace gpo
