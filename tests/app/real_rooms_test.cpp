// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// What the defaults make of recordings that nobody here made.
#include "tests/app/program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

fs::path real(const std::string& name) { return fs::path(GPO_SHARED_DIR) / "data" / name; }

json run(const std::string& name, int start, int frames = 20) {
  const fs::path file = fresh_folder() / "result.json";
  program(fmt::format("run {} --start {} --frames {} --json {}",
                      real(name).string(),
                      start,
                      frames,
                      file.string()));
  return fs::exists(file) ? json::parse(read_file(file)) : json{};
}

/// Window 25 is left out: the camera moved by a tenth of its distance, and the floor's homography
/// passes within the gate of a part of the wall, whose tracks bend the floor by 6 deg.
TEST(RealRooms, EurocsFloorIsFoundFirst) {
  if (!fs::exists(real("euroc-room"))) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  std::vector<double> normal_deg, path_m;
  for (const int start : {0, 5, 10, 15, 20, 30, 35, 40}) {
    const json result = run("euroc-room", start);
    ASSERT_EQ(result["status"], "ok") << start;
    normal_deg.push_back(result["metrics"]["pne_deg"]);
    path_m.push_back(result["metrics"]["ate_m"]);
    EXPECT_LT(normal_deg.back(), 3.5) << start;
    EXPECT_GE(result["planes"].size(), 2) << start;
    const std::array<double, 3> bias = result["bias_rad_s"];
    const std::array known{-0.0022, 0.0208, 0.0765};  // of this flight, by its publishers
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(bias[k], known[k], 0.01) << start;
  }
  std::ranges::sort(normal_deg);
  std::ranges::sort(path_m);
  EXPECT_LT(normal_deg[normal_deg.size() / 2], 1.5);
  EXPECT_LT(path_m[path_m.size() / 2], 0.003);
}

TEST(RealRooms, GravityAndMetersAreWithinTheirSigmasAndFloorAndWallHaveTheirNames) {
  if (!fs::exists(real("euroc-room"))) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  std::vector<double> scale_percent;
  int named_walls = 0;
  for (const int start : {0, 5, 10, 15, 20}) {
    const json result = run("euroc-room", start, 40);
    const json &metrics = result["metrics"], &inertial = result["inertial"];
    EXPECT_LT(metrics["gravity_error_deg"], 1.5) << start;
    const double error = metrics["scale_error_percent"];
    EXPECT_LT(std::abs(std::log1p(error / 100)), 3 * inertial["sigma"].get<double>()) << start;
    scale_percent.push_back(std::abs(error));
    EXPECT_EQ(result["planes"][0]["name"], "floor") << start;
    for (std::size_t k = 1; k < result["planes"].size(); ++k) {
      const json& plane = result["planes"][k];
      EXPECT_EQ(plane.value("name", "wall"), "wall") << start;
      named_walls += plane.contains("name");
    }
  }
  EXPECT_GE(named_walls, 4);  // from 15 on the wall's normal is certain to 41 deg only
  std::ranges::sort(scale_percent);
  EXPECT_LT(scale_percent[2], 5);
}

/// Error of the normal over its standard deviation, with the truth's own.
TEST(RealRooms, StandardDeviationsHold) {
  if (!fs::exists(real("euroc-room"))) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  const std::map<std::string, int> ends{{"euroc-room", 41},
                                        {"chessboard-floor", 230},
                                        {"chessboard-dark", 280},
                                        {"tags-straight", 280},
                                        {"tags-mountain", 560}};
  const std::map<std::string, double> truth_deg{
      {"euroc-room", 0.7}, {"tags-straight", 0.2}, {"tags-mountain", 0.2}};
  std::vector<double> sigmas;
  for (const auto& [name, end] : ends) {
    for (int start = 0; start < end; start += 20) {
      json result = run(name, start);
      if (result.value("status", "") != "ok" || result["metrics"]["pne_deg"].is_null()) continue;
      const json board_deg = result["truth"]["normal_sigma_deg"];
      const double of_truth_deg = truth_deg.contains(name) ? truth_deg.at(name)
                                  : board_deg.is_number()  ? board_deg.get<double>()
                                                           : 0;
      const double own_deg = result["uncertainty"]["normal_sigma_deg"];
      const double error_deg = result["metrics"]["pne_deg"];
      sigmas.push_back(error_deg / std::hypot(own_deg, of_truth_deg));
      EXPECT_TRUE(error_deg < 3 || result["verdict"]["readiness"] == "weak") << name << start;
    }
  }
  ASSERT_GT(sigmas.size(), 50);
  std::ranges::sort(sigmas);
  EXPECT_GT(sigmas[sigmas.size() / 2], 0.5);
  EXPECT_LT(sigmas[sigmas.size() / 2], 2);
  const auto above_four = std::ranges::count_if(sigmas, [](double s) { return s > 4; });
  EXPECT_LE(static_cast<double>(above_four), 0.1 * static_cast<double>(sigmas.size()));
}

}  // namespace
}  // namespace gpo::test
