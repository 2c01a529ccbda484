// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Counterparts of real_rooms_test.cpp on a rendered room that everybody has, with exact truth and
// one fault each.
#include "tests/app/program.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <array>
#include <cmath>
#include <functional>
#include <sstream>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gpo::test {
namespace {

constexpr double kReadout_s = 0.02;
constexpr double kClock_s = 0.008;

/// The result of 30 frames.
json result_from(const fs::path& recording, int start, const std::string& more = "") {
  const fs::path file = fresh_folder() / "result.json";
  program(fmt::format("run {} --start {} --frames 30 {} --json {}",
                      recording.string(),
                      start,
                      more,
                      file.string()));
  return fs::exists(file) ? json::parse(read_file(file)) : json{};
}

/// A copy of the room, one file of which is changed.
fs::path changed_room(const std::string& file,
                      const std::function<std::string(std::string)>& change) {
  fs::path folder = fs::path(GPO_TEST_OUTPUT_DIR) / ("changed-" + fs::path(file).stem().string());
  fs::remove_all(folder);
  fs::copy(small_room(), folder, fs::copy_options::recursive);
  const std::string before = read_file(folder / file), after = change(before);
  EXPECT_NE(before, after);
  write_file(folder / file, after);
  return folder;
}

/// Normal, path, gravity and meters are as accurate as their own standard deviations say.
void expect_accurate(const json& result) {
  ASSERT_EQ(result.value("status", ""), "ok") << result.dump().substr(0, 300);
  const json &metrics = result["metrics"], &inertial = result["inertial"];
  const double error_deg = metrics["pne_deg"];
  EXPECT_LT(error_deg, 0.8);
  EXPECT_LT(error_deg, 4 * result["uncertainty"]["normal_sigma_deg"].get<double>());
  EXPECT_LT(metrics["ate_m"], 0.002);
  EXPECT_LT(metrics["gravity_error_deg"], 1.5);
  EXPECT_LT(std::abs(std::log1p(metrics["scale_error_percent"].get<double>() / 100)),
            4 * inertial["sigma"].get<double>());
  EXPECT_EQ(result["planes"][0]["name"], "floor");
  EXPECT_GE(result["planes"].size(), 3);
  for (std::size_t k = 1; k < result["planes"].size(); ++k)
    EXPECT_NE(result["planes"][k].value("name", ""), "floor");
}

class RenderedRooms : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Starts, RenderedRooms, testing::Values(0, 20));

TEST_P(RenderedRooms, FloorGravityAndMetersAreFoundWithoutFaults) {
  const json result = result_from(small_room(), GetParam());
  expect_accurate(result);
  const std::array truth{-0.0031, 0.0212, 0.0771};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(result["bias_rad_s"][k], truth[k], 0.002);
}

TEST_P(RenderedRooms, RollingShutterIsEstimated) {
  const json result = result_from(small_room(kReadout_s), GetParam());
  expect_accurate(result);
  EXPECT_NEAR(result["row_delay_s"], kReadout_s / 240, 0.1 * kReadout_s / 240);
}

TEST_P(RenderedRooms, LensResidualIsWithinTheUncertainty) {
  const auto bend = [](std::string text) {
    for (const auto& [from, to] : {std::pair("0.092", "0.080"), std::pair("-0.184", "-0.150")})
      text.replace(text.find(from), std::string(from).size(), to);
    return text;
  };
  expect_accurate(result_from(changed_room("mav0/cam0/sensor.yaml", bend), GetParam()));
}

TEST_P(RenderedRooms, LateClockIsEstimated) {
  const auto delay = [](const std::string& text) {
    std::istringstream lines(text);
    std::string late;
    for (std::string line; std::getline(lines, line);) {
      const std::size_t comma = line.find(',');
      if (line.starts_with('#'))
        late += line + "\n";
      else
        late += std::to_string(std::stoll(line) + std::llround(1e9 * kClock_s)) +
                line.substr(comma) + "\n";
    }
    return late;
  };
  const json result =
      result_from(changed_room("mav0/imu0/data.csv", delay), GetParam(), "--time-offset");
  expect_accurate(result);
  EXPECT_NEAR(result["time_offset_s"], kClock_s, 0.001);
}

}  // namespace
}  // namespace gpo::test
