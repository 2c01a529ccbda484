// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/synthesize.h"

#include "engine/base/error.h"
#include "engine/synthesis/renderer.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <fstream>
#include <numbers>
#include <sstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <opencv2/imgcodecs.hpp>
#include <yaml-cpp/yaml.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// The numbers of a CSV file, row by row, without its header; time stamps apart.
struct Table {
  std::vector<std::int64_t> timestamps;
  std::vector<std::vector<double>> rows;
};
Table read_table(const fs::path& file) {
  Table table;
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    std::istringstream cells(line);
    std::string cell;
    std::getline(cells, cell, ',');
    table.timestamps.push_back(std::stoll(cell));
    auto& row = table.rows.emplace_back();
    while (std::getline(cells, cell, ',')) row.push_back(std::stod(cell));
  }
  return table;
}

TEST(Synthesize, WritesTheEurocLayout) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path output = test_folder("out") / "recording";
  int last = 0;
  synthesize(recipe, output, [&](int done, int of) {
    EXPECT_EQ(of, 4);
    last = done;
  });
  EXPECT_EQ(last, 4);
  std::vector<std::string> names;
  for (const auto& [name, bytes] : folder_contents(output)) names.push_back(name);
  EXPECT_THAT(names,
              testing::ElementsAre("board.yaml",
                                   "mav0/cam0/data.csv",
                                   "mav0/cam0/data/5000000000.png",
                                   "mav0/cam0/data/5033333333.png",
                                   "mav0/cam0/data/5066666667.png",
                                   "mav0/cam0/data/5100000000.png",
                                   "mav0/cam0/sensor.yaml",
                                   "mav0/imu0/data.csv",
                                   "mav0/imu0/sensor.yaml",
                                   "mav0/state_groundtruth_estimate0/data.csv",
                                   "plane.yaml"));
  EXPECT_FALSE(fs::exists(output.string() + ".unfinished"));
  EXPECT_EQ(cv::imread((output / "mav0/cam0/data/5033333333.png").string()).size(),
            cv::Size(160, 120));

  const YAML::Node camera = YAML::LoadFile((output / "mav0/cam0/sensor.yaml").string());
  EXPECT_EQ(camera["camera_model"].as<std::string>(), "pinhole");
  EXPECT_EQ(camera["intrinsics"][1].as<double>(), 124);
  EXPECT_EQ(camera["distortion_coefficients"][1].as<double>(), -0.2);
  EXPECT_EQ(camera["T_BS"]["data"][7].as<double>(), 0.06);
  const YAML::Node imu = YAML::LoadFile((output / "mav0/imu0/sensor.yaml").string());
  EXPECT_EQ(imu["gyroscope_bias"][0].as<double>(), 0.0065);
  const YAML::Node plane = YAML::LoadFile((output / "plane.yaml").string());
  EXPECT_EQ(plane["normal"][2].as<double>(), 1);
  EXPECT_EQ(plane["distance"].as<double>(), 0);
  EXPECT_EQ(YAML::LoadFile((output / "board.yaml").string())["square"].as<double>(), 0.03);
}

TEST(Synthesize, TruthTimesExtrinsicsIsTheCamera) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path output = test_folder("out") / "recording";
  synthesize(recipe, output);
  const Table truth = read_table(output / "mav0/state_groundtruth_estimate0/data.csv");
  ASSERT_EQ(truth.rows.size(), 4U);
  for (int frame = 0; frame < 4; ++frame) {
    const auto& row = truth.rows[static_cast<std::size_t>(frame)];
    ASSERT_EQ(row.size(), 16U);
    ASSERT_EQ(truth.timestamps[static_cast<std::size_t>(frame)], frame_timestamp_ns(recipe, frame));
    const Pose body{Eigen::Quaterniond(row[3], row[4], row[5], row[6]).toRotationMatrix(),
                    {row[0], row[1], row[2]}};
    const Pose camera = body * recipe.T_body_camera;
    const Pose expected =
        camera_motion(recipe.trajectory,
                      trajectory_seconds(recipe, frame_timestamp_ns(recipe, frame)))
            .pose;
    EXPECT_LT((camera.p_wc - expected.p_wc).norm(), 1e-11);
    EXPECT_LT((camera.R_wc - expected.R_wc).norm(), 1e-11);
    EXPECT_EQ(row[10], 0.006);
  }
}

TEST(Synthesize, SameRecipeSameBytesWhateverTheThreads) {
  for (const std::string image :
       {"format: png", "format: jpg", "rolling_shutter: 0.02, format: png"}) {
    const Recipe recipe = recipe_of(small_recipe_with("format: png", image));
    const fs::path folder = test_folder("out");
    synthesize(recipe, folder / "one", {}, 1);
    synthesize(recipe, folder / "three", {}, 3);
    EXPECT_EQ(folder_contents(folder / "one"), folder_contents(folder / "three"));
  }
}

TEST(Synthesize, AnotherSeedOnlyChangesTheNoise) {
  Recipe recipe = recipe_of(small_recipe_text());
  const fs::path folder = test_folder("out");
  synthesize(recipe, folder / "a");
  recipe.seed = 4;
  synthesize(recipe, folder / "b");
  const auto a = folder_contents(folder / "a");
  const auto b = folder_contents(folder / "b");
  EXPECT_NE(a.at("mav0/imu0/data.csv"), b.at("mav0/imu0/data.csv"));
  EXPECT_NE(a.at("mav0/cam0/data/5000000000.png"), b.at("mav0/cam0/data/5000000000.png"));
  EXPECT_EQ(a.at("mav0/state_groundtruth_estimate0/data.csv"),
            b.at("mav0/state_groundtruth_estimate0/data.csv"));
  EXPECT_EQ(a.at("mav0/cam0/sensor.yaml"), b.at("mav0/cam0/sensor.yaml"));
}

template <int N>
Path<N> later(Path<N> path, double seconds) {
  path.start += path.velocity * seconds;
  for (Harmonic<N>& h : path.harmonics) h.phase += 2 * std::numbers::pi * h.frequency * seconds;
  return path;
}

/// The same way, so many seconds ahead.
Trajectory later(const Trajectory& trajectory, double seconds) {
  return {later(trajectory.position, seconds),
          later(trajectory.look_at, seconds),
          later(trajectory.roll, seconds),
          trajectory.up};
}

Trajectory at_rest(const Trajectory& trajectory) {
  Trajectory rest;
  rest.position.start = trajectory.position.start;
  rest.look_at.start = trajectory.look_at.start;
  rest.roll.start = trajectory.roll.start;
  return rest;
}

/// Pictures whose rows do not depend on each other, and without noise.
Recipe rolling_recipe(double exposure, double readout) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.image.noise = 0;
  recipe.image.blur = 0;
  recipe.image.gain_variation = 0;
  recipe.image.exposure = exposure;
  recipe.image.rolling_shutter = readout;
  recipe.frame_count = 2;
  return recipe;
}

cv::Mat second_image(const Recipe& recipe, const std::string& folder) {
  const fs::path output = test_folder(folder) / "recording";
  synthesize(recipe, output);
  return cv::imread((output / "mav0/cam0/data/5033333333.png").string());
}

TEST(Synthesize, RollingShutterIsComposedOfGlobalImagesAtTheRowsTimes) {
  for (const double exposure : {0.0, 0.006}) {
    const Recipe recipe = rolling_recipe(exposure, 0.03);
    const cv::Mat rolling = second_image(recipe, "rolling");
    for (const int row : {0, 50, 119}) {
      // The row's time becomes the second frame's.
      Recipe global = rolling_recipe(exposure, 0);
      const std::int64_t timestamp = frame_timestamp_ns(recipe, 1);
      const double shift =
          row_seconds(recipe, timestamp, row) - trajectory_seconds(recipe, timestamp);
      global.trajectory = later(recipe.trajectory, shift);
      const cv::Mat image = second_image(global, "global");
      EXPECT_LE(cv::norm(rolling.row(row), image.row(row), cv::NORM_INF), 1) << row;
      EXPECT_GT(cv::norm(rolling, image, cv::NORM_INF), 20) << row;
    }
  }
}

TEST(Synthesize, RollingShutterOfACameraAtRestIsAGlobalOne) {
  Recipe recipe = rolling_recipe(0, 0.03);
  recipe.trajectory = at_rest(recipe.trajectory);
  const cv::Mat rolling = second_image(recipe, "rolling");
  recipe.image.rolling_shutter = 0;
  EXPECT_EQ(cv::norm(rolling, second_image(recipe, "global"), cv::NORM_INF), 0);
}

TEST(Synthesize, RollingShutterLeavesTheTruthAlone) {
  const fs::path folder = test_folder("out");
  synthesize(rolling_recipe(0, 0), folder / "global");
  synthesize(rolling_recipe(0, 0.03), folder / "rolling");
  const auto global = folder_contents(folder / "global");
  const auto rolling = folder_contents(folder / "rolling");
  const std::string truth = "mav0/state_groundtruth_estimate0/data.csv";
  EXPECT_EQ(global.at(truth), rolling.at(truth));
  EXPECT_EQ(global.at("mav0/imu0/data.csv"), rolling.at("mav0/imu0/data.csv"));
  const YAML::Node camera = YAML::Load(rolling.at("mav0/cam0/sensor.yaml"));
  EXPECT_EQ(camera["rolling_shutter"].as<double>(), 0.03);
}

TEST(Synthesize, LeavesOutWhatTheRecipeLeavesOut) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.desk.board.reset();
  recipe.gyroscope.calibrated_bias.reset();
  const fs::path output = test_folder("out") / "recording";
  synthesize(recipe, output);
  EXPECT_FALSE(fs::exists(output / "board.yaml"));
  EXPECT_FALSE(YAML::LoadFile((output / "mav0/imu0/sensor.yaml").string())["gyroscope_bias"]);
}

TEST(Synthesize, RubbleHasNoTruePlane) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.desk = {};
  recipe.rubble = {{5, {0.05, 0.1}, {-0.2, 0, 0}, {0.2, 0.2, 0.2}, 1}};
  const fs::path output = test_folder("out") / "recording";
  synthesize(recipe, output);
  EXPECT_FALSE(fs::exists(output / "plane.yaml"));
  EXPECT_TRUE(fs::exists(output / "mav0/state_groundtruth_estimate0/data.csv"));
}

TEST(Synthesize, FloorOfARoomIsItsTruePlane) {
  Recipe recipe = recipe_of(small_recipe_text());
  WallRecipe wall;
  wall.from = {-0.3, 0.2};
  wall.to = {0.3, 0.2};
  wall.height = 0.3;
  recipe.desk.walls = {wall};
  const fs::path output = test_folder("out") / "recording";
  synthesize(recipe, output);
  const YAML::Node plane = YAML::LoadFile((output / "plane.yaml").string());
  EXPECT_EQ(plane["normal"][2].as<double>(), 1);
  EXPECT_EQ(plane["distance"].as<double>(), 0);
}

TEST(Synthesize, RefusesAFolderWithSomethingInIt) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path output = test_folder("out");
  std::ofstream(output / "mine.txt") << "precious";
  try {
    synthesize(recipe, output);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(
        error.what(),
        output.string() + ": is not empty; choose a new or empty folder");
  }
  EXPECT_EQ(folder_contents(output).size(), 1U);
  EXPECT_FALSE(fs::exists(output.string() + ".unfinished"));
}

TEST(Synthesize, FillsAnEmptyFolder) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path output = test_folder("out");
  synthesize(recipe, output);
  EXPECT_TRUE(fs::exists(output / "mav0/cam0/data.csv"));
}

TEST(Synthesize, NamesAnOutputThatCannotBeMade) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path file = test_folder("out") / "file";
  std::ofstream(file) << "not a folder";
  try {
    synthesize(recipe, file / "recording");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("cannot be created"));
    EXPECT_THAT(error.what(), testing::EndsWith(": Not a directory"));
  }
}

TEST(Synthesize, LeavesNothingBehindWhereItIsStopped) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path folder = test_folder("out");
  const auto stop = [](int, int) { throw std::runtime_error("stopped"); };
  EXPECT_THROW(synthesize(recipe, folder / "recording", stop), std::runtime_error);
  EXPECT_TRUE(fs::is_empty(folder));
}

// Who closes the window does not wait for a desk to be painted.
TEST(Synthesize, TellsOfThePartsOfItsSceneBeforeItsFirstImage) {
  const Recipe recipe = recipe_of(small_recipe_text());
  int parts = 0;
  synthesize(recipe, test_folder("parts") / "small", [&](int done, int) { parts += done == 0; });
  EXPECT_GE(parts, 4 + static_cast<int>(recipe.desk.prints.size() + recipe.desk.boxes.size()));
}

class Desk : public testing::Test {
 protected:
  const fs::path folder = fs::path(GPO_SOURCE_DIR) / "sequences" / "desk";
  const Recipe recipe = read_recipe(fs::path(GPO_SOURCE_DIR) / "sequences" / "desk.yaml");

  Pose camera(int frame) const {
    const double t = trajectory_seconds(recipe, frame_timestamp_ns(recipe, frame));
    return camera_motion(recipe.trajectory, t).pose;
  }
};

// Another compiler may round differently, so the comparison is not of bytes.
TEST_F(Desk, CommittedRecordingIsWhatTheRecipeMakes) {
  const Table imu = read_table(folder / "mav0/imu0/data.csv");
  const auto samples = simulate_imu(recipe);
  ASSERT_EQ(imu.rows.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(imu.timestamps[i], samples[i].timestamp_ns);
    for (int k = 0; k < 3; ++k) {
      ASSERT_NEAR(imu.rows[i][static_cast<std::size_t>(k)], samples[i].rate_b[k], 2e-9);
    }
  }
  const Table truth = read_table(folder / "mav0/state_groundtruth_estimate0/data.csv");
  ASSERT_EQ(truth.rows.size(), 60U);
  const Pose last = camera(59) * inverse(recipe.T_body_camera);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(truth.rows[59][static_cast<std::size_t>(k)], last.p_wc[k], 1e-9);
  }
  const Scene scene = make_scene(recipe.desk, 2);
  const RayMap rays = make_ray_map(recipe.camera, 2, 2);
  const cv::Mat made = expose(render(scene, rays, {camera(0)}, 2), recipe.image, 1, 1, 2);
  const cv::Mat committed = cv::imread(
      (folder / "mav0/cam0/data" / (std::to_string(frame_timestamp_ns(recipe, 0)) + ".jpg"))
          .string());
  ASSERT_EQ(committed.size(), made.size());
  const auto pixels = static_cast<double>(made.total() * 3);
  EXPECT_LT(cv::norm(made, committed, cv::NORM_L1) / pixels, 4);
}

TEST_F(Desk, CommittedImagesShowTheBoardWhereTheTruthSays) {
  const Table truth = read_table(folder / "mav0/state_groundtruth_estimate0/data.csv");
  for (const std::size_t frame : {0U, 20U, 40U, 59U}) {
    const auto& row = truth.rows[frame];
    const Pose body{Eigen::Quaterniond(row[3], row[4], row[5], row[6]).toRotationMatrix(),
                    {row[0], row[1], row[2]}};
    const cv::Mat image = cv::imread(
        (folder / "mav0/cam0/data" / (std::to_string(truth.timestamps[frame]) + ".jpg")).string());
    const CornerError error = corner_error(recipe, body * recipe.T_body_camera, image);
    EXPECT_LT(error.rms, 0.1);
    EXPECT_LT(error.mean, 0.03);
  }
}

TEST_F(Desk, BoardIsWithinEveryFrame) {
  for (int frame = 0; frame < recipe.frame_count; ++frame) {
    for (const Eigen::Vector3d& corner : board_corners(*recipe.desk.board)) {
      const Eigen::Vector2d px = project(recipe.camera, to_camera(camera(frame), corner));
      EXPECT_TRUE((px.array() > 25).all() && px.x() < 615 && px.y() < 455) << frame;
    }
  }
}

TEST_F(Desk, EveryWindowOfThirtyFramesHasParallax) {
  for (int start = 0; start + 30 <= recipe.frame_count; ++start) {
    double extent = 0;
    for (int i = 1; i < 30; ++i) {
      extent = std::max(extent, (camera(start + i).p_wc - camera(start).p_wc).norm());
    }
    const double distance = camera(start).p_wc.z();
    EXPECT_GT(extent / distance, 0.22) << start;
    EXPECT_LT(extent / distance, 0.42) << start;
  }
}

}  // namespace
}  // namespace gpo
