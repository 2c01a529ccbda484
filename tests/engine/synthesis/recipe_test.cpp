// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/synthesis/synthesize.h"
#include "tests/engine/synthesis/small_recipe.h"
#include "tests/engine/test_folder.h"

#include <cmath>
#include <regex>
#include <sstream>

#include <Eigen/LU>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::EndsWith, testing::HasSubstr;

std::string message_of(const std::string& text) {
  return test::error_of([&] { recipe_of(text); });
}

TEST(Recipe, ReadsEveryPartAndEveryDigitOfATimeStamp) {
  const Recipe recipe = recipe_of(small_recipe_text());
  EXPECT_EQ(recipe.seed, 3U);
  EXPECT_EQ(recipe.camera.width, 160);
  EXPECT_EQ(recipe.camera.fy, 124);
  EXPECT_EQ(recipe.camera.distortion, Distortion::radial_tangential);
  EXPECT_EQ(recipe.camera.coefficients.size(), 4U);
  EXPECT_EQ(recipe.T_body_camera.p_wc, Eigen::Vector3d(0.02, 0.06, -0.004));
  EXPECT_EQ(recipe.T_body_camera.R_wc(0, 1), -1);
  EXPECT_EQ(recipe.frame_count, 4);
  EXPECT_EQ(recipe.start_ns, 5000000000);
  EXPECT_NEAR(recipe.trajectory.position.velocity.x(), 0.8, 1e-12);
  ASSERT_EQ(recipe.trajectory.position.harmonics.size(), 1U);
  EXPECT_NEAR(recipe.trajectory.position.harmonics[0].phase, radians(30), 1e-12);
  EXPECT_NEAR(recipe.trajectory.roll.start(0), radians(-2), 1e-12);
  ASSERT_TRUE(recipe.desk.board);
  EXPECT_EQ(recipe.desk.board->columns, 5);
  ASSERT_EQ(recipe.desk.prints.size(), 1U);
  EXPECT_EQ(recipe.desk.prints[0].kind, "card");
  ASSERT_EQ(recipe.desk.boxes.size(), 1U);
  EXPECT_NEAR(recipe.desk.boxes[0].angle, radians(30), 1e-12);
  EXPECT_EQ(recipe.image.format, "png");
  EXPECT_EQ(recipe.image.exposure, 0.004);
  EXPECT_EQ(recipe.image.rolling_shutter, 0);
  EXPECT_EQ(recipe.gyroscope.bias, Eigen::Vector3d(0.006, -0.004, 0.003));
  ASSERT_TRUE(recipe.gyroscope.calibrated_bias);
  const Recipe late =
      recipe_of(small_recipe_with("start_ns: 5000000000", "start_ns: 1520530308199447627"));
  EXPECT_EQ(frame_timestamp_ns(late, 0), 1520530308199447627);
  EXPECT_EQ(frame_timestamp_ns(late, 3), 1520530308299447627);
}

TEST(Recipe, ReadsTheMiddleRowAtTheTimeStamp) {
  const Recipe rolling =
      recipe_of(small_recipe_with("exposure: 0.004", "exposure: 0.004, rolling_shutter: 0.02"));
  const std::int64_t timestamp = frame_timestamp_ns(rolling, 3);
  EXPECT_NEAR(row_seconds(rolling, timestamp, 0), 0.09, 1e-9);
  EXPECT_NEAR(row_seconds(rolling, timestamp, 119), 0.11, 1e-9);
  const double next_to_middle = row_seconds(rolling, timestamp, 59);
  const Recipe upward = recipe_of(
      small_recipe_with("exposure: 0.004", "rolling_shutter: 0.02, readout_direction: up"));
  EXPECT_NEAR(row_seconds(upward, timestamp, 119), 0.09, 1e-9);
  EXPECT_NEAR((next_to_middle + row_seconds(rolling, timestamp, 60)) / 2, 0.1, 1e-9);
  const Recipe global = recipe_of(small_recipe_text());
  EXPECT_EQ(row_seconds(global, timestamp, 0), trajectory_seconds(global, timestamp));
  EXPECT_EQ(row_seconds(global, timestamp, 119), trajectory_seconds(global, timestamp));
}

TEST(Recipe, NamesMissingFilesAndLinesOfBrokenYaml) {
  EXPECT_EQ(test::error_of([] { read_recipe("/no/such/recipe.yaml"); }),
            "/no/such/recipe.yaml: no such file");
  EXPECT_THAT(message_of(small_recipe_with("seed: 3", "seed: [3")),
              testing::AllOf(HasSubstr("small.yaml:2: found "), EndsWith(", expected YAML")));
  EXPECT_THAT(message_of("just words"),
              EndsWith("small.yaml:1: found \"just words\", expected keys and values"));
}

/// Expects messages for a table of two lines each: "from => to", or "from", for `text_of`, and
/// the end of the message, or a part of it followed by "...".
void expect_messages(const char* table,
                     const std::function<std::string(std::string from, std::string to)>& text_of) {
  std::istringstream lines(table);
  for (std::string change, end; std::getline(lines, change) && std::getline(lines, end);) {
    change = std::regex_replace(change, std::regex(R"(\\n)"), "\n");
    const std::size_t arrow = change.find(" => ");
    const std::string to = arrow == std::string::npos ? "" : change.substr(arrow + 4);
    const std::string message = message_of(text_of(change.substr(0, arrow), to));
    if (end.ends_with("..."))
      EXPECT_THAT(message, HasSubstr(end.substr(0, end.size() - 3)));
    else
      EXPECT_THAT(message, EndsWith(end));
  }
}

TEST(Recipe, NamesLineKeyValueAndExpectation) {
  expect_messages(R"({kind: card, => {kind: card, color: red,
small.yaml:22: key `desk.prints[0].color`: found an unknown key...
  rate: 200\n
small.yaml:27: key `gyroscope.rate`: found no value, expected a number [Hz] from 1 to 10000
seed: 3\n => seed: 3\nseed: 4\n
small.yaml:2: key `seed`: found a second time, expected each key once
rate: 200 => rate: fast
small.yaml:27: key `gyroscope.rate`: found "fast", expected a number [Hz] from 1 to 10000
count: 4 => count: 4.5
key `frames.count`: found "4.5", expected a whole number from 1 to 100000
size: [0.7, 0.6] => size: [0.7]
key `desk.size`: found a list of 1, expected a list of 2 numbers
size: [0.7, 0.6] => size: 0.7
key `desk.size`: found "0.7", expected a list of 2 numbers
frames: {count: 4, rate: 30, start_ns: 5000000000} => frames: 4
key `frames`: found "4", expected keys and values
samples: 2 => samples: 0
key `picture.samples`: found "0", expected a whole number from 1 to 16
noise: 1, => noise: .nan,
found ".nan", expected a number [gray levels] from 0 to 100
start_ns: 5000000000 => start_ns: 0
frames.start_ns...
exposure: 0.004 => rolling_shutter: -0.01
key `picture.rolling_shutter`: found "-0.01", expected a number [s] from 0 to 0.033...
exposure: 0.004 => rolling_shutter: 0.04
key `picture.rolling_shutter`: found "0.04"...
exposure: 0.004 => readout_direction: back
key `picture.readout_direction`: found "back", expected one of down, left, up, right
format: png => format: bmp
key `picture.format`: found "bmp", expected one of jpg, png
radial-tangential => fov
found "fov", expected one of none, radial-tangential, equidistant
kind: cube => kind: sphere
key `desk.boxes[0].kind`: found "sphere", expected one of book, carton, cube, shelf, wooden
[0, -1, 0, 0.02, => [0, -2, 0, 0.02,
key `camera.T_BS`: found no rotation in it, expected a rigid 4x4 transformation, row by row
start: [-0.05, -0.35, 0.42]\n    end: [0.03, -0.35, 0.42] => start: [0, 0, -0.4]
key `trajectory`: found a camera below the desk in frame 0...
start: [0, 0, 0], end: [0.02, 0.01, 0]} => start: [-0.045, -0.34, 0.4275], end: [0, 0, 0]}\n  up: [0, 0, 0]
key `trajectory`: found no direction of view in frame 0...
  texture_seed: 5 =>   surface: marble
key `desk.surface`: found "marble", expected one of wood, parquet, plaster, bricks
  texture_seed: 5 =>   scale: 0.5
key `desk.scale`: found "0.5", expected a number from 1 to 10
gyroscope: => floor: {size: [1, 1]}\ngyroscope:
key `desk`: found an unknown key, expected one of camera, floor, frames...
)",
                  small_recipe_with);
  const std::string known =
      "found an unknown key, expected one of board, boxes, prints, scale, size, surface, "
      "texture_seed, walls";
  EXPECT_THAT(message_of(small_recipe_with("  texture_seed: 5", "  texture_sed: 5")),
              EndsWith("small.yaml:19: key `desk.texture_sed`: " + known));
  EXPECT_THAT(message_of(small_recipe_with("  board: {", "  bord: {")),
              EndsWith("key `desk.bord`: " + known));
}

std::string room_text(const std::string& wall) {
  return small_recipe_with("desk:\n  size: [0.7, 0.6]",
                           "floor:\n  size: [0.7, 0.6]\n  scale: 2\n  surface: parquet\n  walls:\n"
                           "    - {" +
                               wall + "}");
}

TEST(Recipe, ReadsARoomAndExplainsInvalidOnes) {
  const Recipe recipe =
      recipe_of(room_text("from: [-0.3, 0.2], to: [0.3, 0.2], height: 0.5, surface: bricks, "
                          "prints: [{kind: map, center: [0.2, 0.3], size: [0.1, 0.08]}]"));
  EXPECT_EQ(recipe.desk.scale, 2);
  EXPECT_EQ(recipe.desk.surface, "parquet");
  ASSERT_EQ(recipe.desk.walls.size(), 1U);
  const WallRecipe& wall = recipe.desk.walls[0];
  EXPECT_EQ(wall.from, Eigen::Vector2d(-0.3, 0.2));
  EXPECT_EQ(wall.to, Eigen::Vector2d(0.3, 0.2));
  EXPECT_EQ(wall.height, 0.5);
  EXPECT_EQ(wall.surface, "bricks");
  ASSERT_EQ(wall.prints.size(), 1U);
  EXPECT_EQ(wall.prints[0].center, Eigen::Vector2d(0.2, 0.3));
  EXPECT_TRUE(has_desk(recipe));
  expect_messages(
      R"(from: [0, 0.2], to: [0, 0.2], height: 0.5
small.yaml:22: key `floor.walls[0].to`: found a wall 0 m long, expected from 0.05 to 10 m
from: [0, 0.2], to: [30, 0.2], height: 0.5
key `floor.walls[0].to`: found a wall 30 m long, expected from 0.05 to 10 m
from: [0, 0.2], height: 0.5
key `floor.walls[0].to`: found no value, expected a list of 2 numbers
from: [0, 0.2], to: [1, 0.2], height: 11
key `floor.walls[0].height`: found "11", expected a number [m] from 0.05 to 10
from: [-0.3, 0.2], to: [0.3, 0.2], height: 0.5, surface: bricks => , color: red
 found an unknown key, expected one of from, height, prints, surface, texture_seed, to
from: [-0.3, 0.2], to: [0.3, 0.2], height: 0.5, surface: bricks => , color: red
key `floor.walls[0].color`: ...
from: [-0.3, 0.2], to: [0.3, 0.2], height: 0.5, surface: bricks => , prints: [{kind: door}]
key `floor.walls[0].prints[0].kind`: found "door", expected one of ...
)",
      [](const std::string& wall, const std::string& more) { return room_text(wall + more); });
  std::string walls = "from: [0, 0], to: [10, 0], height: 10";
  for (int i = 0; i < 2; ++i) walls += "}\n    - {from: [0, 0], to: [10, 0], height: 10";
  EXPECT_THAT(message_of(room_text(walls)),
              EndsWith("key `floor.size`: found surfaces, boxes and prints of 192 million texels, "
                       "expected at most 160 million; increase `scale` or make them smaller; "
                       "--limits allows more"));
}

std::string without_desk(const std::string& replacement) {
  std::string text = small_recipe_text();
  const std::size_t desk = text.find("desk:");
  return text.replace(desk, text.find("picture:") - desk, replacement);
}

std::string rubble_text(const std::string& heap) {
  return without_desk("rubble:\n  - {" + heap + "}\n");
}

TEST(Recipe, ReadsRubbleWithoutADeskAndExplainsInvalidRubble) {
  const Recipe recipe = recipe_of(
      rubble_text("count: 7, size: [0.1, 0.2], low: [-1, -1, -1], high: [1, 2, 3], seed: 9"));
  EXPECT_FALSE(has_desk(recipe));
  ASSERT_EQ(recipe.rubble.size(), 1U);
  EXPECT_EQ(recipe.rubble[0].count, 7);
  EXPECT_EQ(recipe.rubble[0].size, Eigen::Vector2d(0.1, 0.2));
  EXPECT_EQ(recipe.rubble[0].high, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(recipe.rubble[0].seed, 9U);
  expect_messages(
      R"(count: 0, size: [0.1, 0.2] => , low: [-1, -1, -1], high: [1, 2, 3]
small.yaml:18: key `rubble[0].count`: found "0", expected a whole number from 1 to 1000
count: 7, size: [0.2, 0.1] => , low: [-1, -1, -1], high: [1, 2, 3]
key `rubble[0].size`: found the maximum first, expected [minimum, maximum] in meters
count: 7 => , low: [-1, -1, -1], high: [1, 2, 3]
key `rubble[0].size`: found no value, expected a list of 2 numbers
count: 7, size: [0.1, 0.2] => , low: [0, 0, 0], high: [1, -1, 1]
`rubble[0].high`: found a corner below `low`, expected x, y and z of at least those of `low`
count: 7, size: [0.1, 0.2] => , tilt: 3, low: [-1, -1, -1], high: [1, 2, 3]
key `rubble[0].tilt`: found an unknown key, expected one of count, high, low, seed, size
)",
      [](const std::string& heap, const std::string& more) { return rubble_text(heap + more); });
  EXPECT_THAT(message_of(without_desk("")), EndsWith("key `desk`: found no value, expected a map"));
}

Recipe perfect_recipe(int frames, double gyroscope_rate) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.trajectory.position.velocity *= 0.1;
  recipe.trajectory.look_at.velocity *= 0.1;
  recipe.trajectory.look_at.harmonics.push_back({{0.05, 0.08, 0.01}, 0.8, 0.3});
  recipe.trajectory.roll.harmonics.push_back({Eigen::Matrix<double, 1, 1>(0.1), 0.6, 1.0});
  recipe.frame_count = frames;
  recipe.gyroscope = {gyroscope_rate, 0, Eigen::Vector3d::Zero(), {}};
  return recipe;
}

TEST(Trajectory, CameraIsLevelAndLooksAtItsPoint) {
  const Recipe recipe = perfect_recipe(4, 200);
  Trajectory trajectory = recipe.trajectory;
  trajectory.roll = {};
  for (const double t : {-0.05, 0.0, 0.7}) {
    const Pose pose = camera_motion(trajectory, t).pose;
    EXPECT_NEAR(pose.R_wc.determinant(), 1, 1e-12);
    EXPECT_TRUE((pose.R_wc * pose.R_wc.transpose()).isIdentity(1e-12));
    // The y axis of an image points down, its x axis is level.
    EXPECT_LT(pose.R_wc(2, 1), 0);
    EXPECT_NEAR(pose.R_wc(2, 0), 0, 1e-12);
  }
  const Pose first = camera_motion(trajectory, 0).pose;
  const auto& wobble = trajectory.look_at.harmonics[0];
  const Eigen::Vector3d target =
      to_camera(first, trajectory.look_at.start + wobble.amplitude * std::sin(wobble.phase));
  EXPECT_NEAR(target.head<2>().norm(), 0, 1e-12);
  EXPECT_GT(target.z(), 0);
}

TEST(Trajectory, IntegratedRatesAgreeWithRotations) {
  const Recipe recipe = perfect_recipe(61, 10000);
  const auto samples = simulate_imu(recipe);
  const Eigen::Matrix3d R_body_camera = recipe.T_body_camera.R_wc;
  const auto body_rotation = [&](std::int64_t ns) -> Eigen::Matrix3d {
    return camera_motion(recipe.trajectory, trajectory_seconds(recipe, ns)).pose.R_wc *
           R_body_camera.transpose();
  };
  Eigen::Matrix3d R = body_rotation(samples.front().timestamp_ns);
  double worst = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const double dt = 1e-9 * (samples[i].timestamp_ns - samples[i - 1].timestamp_ns);
    R = R * so3_exp(0.5 * dt * (samples[i].rate_b + samples[i - 1].rate_b));
    const Eigen::Matrix3d truth = body_rotation(samples[i].timestamp_ns);
    worst = std::max(worst, so3_log(R.transpose() * truth).norm());
  }
  EXPECT_LT(worst, 1e-6);
  EXPECT_GT(samples.size(), 20000U);
}

TEST(Trajectory, VelocityAndForceAgreeWithFiniteDifferences) {
  const Recipe recipe = perfect_recipe(61, 200);
  const auto body = [&](double t) {
    return body_motion(recipe.trajectory, recipe.T_body_camera, t);
  };
  const double h = 1e-4;
  for (const double t : {0.1, 0.5, 1.3}) {
    const Eigen::Vector3d velocity = (body(t + h).pose.p_wc - body(t - h).pose.p_wc) / (2 * h);
    EXPECT_LT((body(t).velocity_w - velocity).norm(), 1e-6);
    const Eigen::Vector3d acceleration =
        (body(t + h).velocity_w - body(t - h).velocity_w) / (2 * h);
    const Eigen::Vector3d force = body(t).pose.R_wc * body(t).specific_force_b;
    EXPECT_LT((force - acceleration - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-5);
  }
}

TEST(SimulatedImu, CoversTheFramesWithoutTheirTimes) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const auto samples = simulate_imu(recipe);
  EXPECT_LE(samples.front().timestamp_ns, recipe.start_ns - 95'000'000);
  EXPECT_GE(samples.back().timestamp_ns, frame_timestamp_ns(recipe, 3) + 95'000'000);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    for (int frame = 0; frame < recipe.frame_count; ++frame)
      EXPECT_NE(samples[i].timestamp_ns, frame_timestamp_ns(recipe, frame));
    EXPECT_EQ(samples[i].timestamp_ns - samples[0].timestamp_ns, 5'000'000 * std::int64_t(i));
  }
}

TEST(SimulatedImu, HasNoiseAndBiasOfTheRecipe) {
  Recipe recipe = perfect_recipe(3001, 200);
  const auto perfect = simulate_imu(recipe);
  recipe.gyroscope = {200, 0.0002, Eigen::Vector3d(0.006, -0.004, 0.003), {}};
  const auto real = simulate_imu(recipe);
  ASSERT_EQ(real.size(), perfect.size());
  const auto n = static_cast<double>(real.size());
  const double sigma = 0.0002 * std::sqrt(200.0);
  for (int k = 0; k < 3; ++k) {
    double sum = 0, squares = 0, neighbors = 0, previous = 0;
    for (std::size_t i = 0; i < real.size(); ++i) {
      const double noise = real[i].rate_b[k] - perfect[i].rate_b[k] - recipe.gyroscope.bias[k];
      sum += noise;
      squares += noise * noise;
      neighbors += noise * previous;
      previous = noise;
    }
    EXPECT_LT(std::abs(sum / n), 4 * sigma / std::sqrt(n));
    EXPECT_NEAR(std::sqrt(squares / n) / sigma, 1, 4 / std::sqrt(2 * n));
    EXPECT_LT(std::abs(neighbors / squares), 4 / std::sqrt(n));
    EXPECT_EQ(real[7].specific_force_b, perfect[7].specific_force_b);
  }
}

}  // namespace
}  // namespace gpo
