// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/synthesize.h"

#include "engine/recording/images/images.h"
#include "engine/synthesis/renderer.h"
#include "tests/engine/synthesis/small_recipe.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <iterator>
#include <numbers>
#include <sstream>
#include <utility>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <yaml-cpp/yaml.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

/// Time stamps and other numbers of a CSV file without its header.
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
    std::ranges::replace(line, ',', ' ');
    std::istringstream cells(line);
    cells >> table.timestamps.emplace_back();
    table.rows.emplace_back(std::istream_iterator<double>(cells), std::istream_iterator<double>());
  }
  return table;
}

Pose pose_of(const std::vector<double>& row) {
  return {Eigen::Quaterniond(row[3], row[4], row[5], row[6]).toRotationMatrix(),
          {row[0], row[1], row[2]}};
}

/// Synthesizes into a folder of the running test and returns it.
fs::path synthesized(const Recipe& recipe, const std::string& name = "recording", int threads = 2) {
  const fs::path output = test_folder(name) / "recording";
  synthesize(recipe, output, {}, threads);
  return output;
}

const std::string kTruthFile = "mav0/state_groundtruth_estimate0/data.csv";
const std::string kImuFile = "mav0/imu0/data.csv";

bool has_unfinished(const fs::path& output) {
  const std::string start = output.filename().string() + ".";
  return std::ranges::any_of(fs::directory_iterator(output.parent_path()), [&](const auto& entry) {
    return entry.path().filename().string().starts_with(start);
  });
}

TEST(Synthesize, WritesTheEurocLayout) {
  const fs::path output = test_folder("out") / "recording";
  int last = 0;
  const Recipe recipe = recipe_of(small_recipe_text());
  synthesize(recipe, output, [&](int done, int of) {
    EXPECT_EQ(of, 4);
    last = done;
  });
  EXPECT_EQ(last, 4);
  std::string names;
  for (const auto& [name, bytes] : folder_contents(output)) names += name + " ";
  EXPECT_EQ(names,
            "board.yaml mav0/cam0/data.csv mav0/cam0/data/5000000000.png "
            "mav0/cam0/data/5033333333.png mav0/cam0/data/5066666667.png "
            "mav0/cam0/data/5100000000.png mav0/cam0/sensor.yaml mav0/imu0/data.csv "
            "mav0/imu0/sensor.yaml mav0/state_groundtruth_estimate0/data.csv plane.yaml ");
  EXPECT_FALSE(has_unfinished(output));
  EXPECT_EQ(read_image(output / "mav0/cam0/data/5033333333.png").size(), cv::Size(160, 120));

  const YAML::Node camera = YAML::LoadFile((output / "mav0/cam0/sensor.yaml").string());
  EXPECT_EQ(camera["camera_model"].as<std::string>(), "pinhole");
  EXPECT_EQ(camera["intrinsics"][1].as<double>(), 124);
  EXPECT_EQ(camera["distortion_coefficients"][1].as<double>(), -0.2);
  EXPECT_EQ(camera["T_BS"]["data"][7].as<double>(), 0.06);
  const YAML::Node imu = YAML::LoadFile((output / "mav0/imu0/sensor.yaml").string());
  EXPECT_EQ(imu["gyroscope_bias"][0].as<double>(), 0.0065);
  EXPECT_EQ(YAML::LoadFile((output / "board.yaml").string())["square"].as<double>(), 0.03);
}

TEST(Synthesize, TruthTimesExtrinsicsIsTheCamera) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const Table truth = read_table(synthesized(recipe) / kTruthFile);
  ASSERT_EQ(truth.rows.size(), 4U);
  for (int frame = 0; frame < 4; ++frame) {
    ASSERT_EQ(truth.rows[frame].size(), 16U);
    ASSERT_EQ(truth.timestamps[frame], frame_timestamp_ns(recipe, frame));
    const Pose camera = pose_of(truth.rows[frame]) * recipe.T_body_camera;
    const Pose expected = camera_of(recipe, frame);
    EXPECT_LT((camera.p_wc - expected.p_wc).norm(), 1e-11);
    EXPECT_LT((camera.R_wc - expected.R_wc).norm(), 1e-11);
    EXPECT_EQ(truth.rows[frame][10], 0.006);
  }
}

TEST(Synthesize, WritesTheSameBytesWithAnyNumberOfThreads) {
  for (const std::string image :
       {"format: png", "format: jpg", "rolling_shutter: 0.02, format: png"}) {
    const Recipe recipe = recipe_of(small_recipe_with("format: png", image));
    EXPECT_EQ(folder_contents(synthesized(recipe, "one", 1)),
              folder_contents(synthesized(recipe, "three", 3)));
  }
}

TEST(Synthesize, AnotherSeedOnlyChangesTheNoise) {
  Recipe recipe = recipe_of(small_recipe_text());
  const auto a = folder_contents(synthesized(recipe, "a"));
  recipe.seed = 4;
  const auto b = folder_contents(synthesized(recipe, "b"));
  EXPECT_NE(a.at(kImuFile), b.at(kImuFile));
  EXPECT_NE(a.at("mav0/cam0/data/5000000000.png"), b.at("mav0/cam0/data/5000000000.png"));
  EXPECT_EQ(a.at(kTruthFile), b.at(kTruthFile));
  EXPECT_EQ(a.at("mav0/cam0/sensor.yaml"), b.at("mav0/cam0/sensor.yaml"));
}

template <int N>
void advance(Path<N>& path, double seconds) {
  path.start += path.velocity * seconds;
  for (Harmonic<N>& h : path.harmonics) h.phase += 2 * std::numbers::pi * h.frequency * seconds;
}

/// Images without noise and with independent rows.
Recipe rolling_recipe(double exposure, double readout) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.image.noise = recipe.image.blur = recipe.image.gain_variation = 0;
  recipe.image.exposure = exposure;
  recipe.image.rolling_shutter = readout;
  recipe.frame_count = 2;
  return recipe;
}

cv::Mat second_image(const Recipe& recipe, const std::string& folder) {
  return read_image(synthesized(recipe, folder) / "mav0/cam0/data/5033333333.png");
}

TEST(Synthesize, RollingShutterConsistsOfGlobalImagesAndLeavesTheTruthUnchanged) {
  for (const double exposure : {0.0, 0.006}) {
    const Recipe recipe = rolling_recipe(exposure, 0.03);
    const cv::Mat rolling = second_image(recipe, "rolling");
    for (const int row : {0, 50, 119}) {
      // Shifts the time of the row to the second frame.
      Recipe global = rolling_recipe(exposure, 0);
      const std::int64_t timestamp = frame_timestamp_ns(recipe, 1);
      const double shift =
          row_seconds(recipe, timestamp, row) - trajectory_seconds(recipe, timestamp);
      advance(global.trajectory.position, shift);
      advance(global.trajectory.look_at, shift);
      advance(global.trajectory.roll, shift);
      const cv::Mat image = second_image(global, "global");
      EXPECT_LE(cv::norm(rolling.row(row), image.row(row), cv::NORM_INF), 1) << row;
      EXPECT_GT(cv::norm(rolling, image, cv::NORM_INF), 20) << row;
    }
  }
  const auto global = folder_contents(synthesized(rolling_recipe(0, 0), "global"));
  const auto rolling = folder_contents(synthesized(rolling_recipe(0, 0.03), "rolling"));
  EXPECT_EQ(global.at(kTruthFile), rolling.at(kTruthFile));
  EXPECT_EQ(global.at(kImuFile), rolling.at(kImuFile));
  const YAML::Node camera = YAML::Load(rolling.at("mav0/cam0/sensor.yaml"));
  EXPECT_EQ(camera["rolling_shutter"].as<double>(), 0.03);
}

TEST(Synthesize, ReadsTheImagesOfATurnedCameraByColumns) {
  Recipe upright = rolling_recipe(0, 0.03);
  upright.camera.coefficients = {0.1, -0.2, 0, 0};
  Recipe turned = upright;
  Camera& camera = turned.camera;
  std::swap(camera.width, camera.height);
  std::swap(camera.fx, camera.fy);
  camera.cx = upright.camera.height - 1 - upright.camera.cy;
  camera.cy = upright.camera.cx;
  camera.readout_direction = ReadoutDirection::left;
  turned.trajectory.roll.start(0) -= std::numbers::pi / 2;
  cv::Mat expected;
  cv::rotate(second_image(upright, "upright"), expected, cv::ROTATE_90_CLOCKWISE);
  const cv::Mat image = second_image(turned, "turned");
  ASSERT_EQ(image.size(), expected.size());
  EXPECT_LT(cv::norm(image, expected, cv::NORM_L1) / static_cast<double>(3 * image.total()), 0.05);
}

TEST(Synthesize, LeavesOutOptionalFiles) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.desk.board.reset();
  recipe.gyroscope.calibrated_bias.reset();
  const fs::path output = synthesized(recipe);
  EXPECT_FALSE(fs::exists(output / "board.yaml"));
  EXPECT_FALSE(YAML::LoadFile((output / "mav0/imu0/sensor.yaml").string())["gyroscope_bias"]);
}

TEST(Synthesize, TruePlaneIsDeskOrFloorAndMissingForRubble) {
  Recipe recipe = recipe_of(small_recipe_text());
  for (const bool room : {false, true}) {
    if (room) recipe.desk.walls = {WallRecipe{{-0.3, 0.2}, {0.3, 0.2}, 0.3}};
    const YAML::Node plane = YAML::LoadFile((synthesized(recipe) / "plane.yaml").string());
    EXPECT_EQ(plane["normal"][2].as<double>(), 1);
    EXPECT_EQ(plane["distance"].as<double>(), 0);
  }
  recipe.desk = {};
  recipe.rubble = {{5, {0.05, 0.1}, {-0.2, 0, 0}, {0.2, 0.2, 0.2}, 1}};
  const fs::path output = synthesized(recipe);
  EXPECT_FALSE(fs::exists(output / "plane.yaml"));
  EXPECT_TRUE(fs::exists(output / kTruthFile));
}

TEST(Synthesize, RefusesOnlyFoldersWithFilesAndBadPlaces) {
  const Recipe recipe = recipe_of(small_recipe_text());
  const fs::path output = test_folder("out");
  std::ofstream(output / "mine.txt") << "precious";
  EXPECT_EQ(test::error_of([&] { synthesize(recipe, output); }),
            output.string() + ": is not empty; choose a new or empty folder");
  EXPECT_EQ(folder_contents(output).size(), 1U);
  EXPECT_FALSE(has_unfinished(output));
  EXPECT_THAT(test::error_of([&] { synthesize(recipe, output / "mine.txt" / "recording"); }),
              testing::AllOf(testing::HasSubstr("cannot be created"),
                             testing::EndsWith("Not a directory")));
  fs::remove(output / "mine.txt");
  synthesize(recipe, output);
  EXPECT_TRUE(fs::exists(output / "mav0/cam0/data.csv"));
}

class Desk : public testing::Test {
 protected:
  const fs::path folder = fs::path(GPO_SOURCE_DIR) / "sequences" / "desk";
  const Recipe recipe = read_recipe(fs::path(GPO_SOURCE_DIR) / "sequences" / "desk.yaml");

  cv::Mat image(std::int64_t timestamp) const {
    return read_image(folder / "mav0/cam0/data" / (std::to_string(timestamp) + ".jpg"));
  }
};

// Another compiler may round differently, so bytes may differ.
TEST_F(Desk, CommittedRecordingAgreesWithItsRecipe) {
  const Table imu = read_table(folder / kImuFile);
  const auto samples = simulate_imu(recipe);
  ASSERT_EQ(imu.rows.size(), samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    ASSERT_EQ(imu.timestamps[i], samples[i].timestamp_ns);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(imu.rows[i][k], samples[i].rate_b[k], 2e-9);
  }
  const Table truth = read_table(folder / kTruthFile);
  ASSERT_EQ(truth.rows.size(), 60U);
  const Pose last = camera_of(recipe, 59) * inverse(recipe.T_body_camera);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(truth.rows[59][k], last.p_wc[k], 1e-9);
  const Scene scene = make_scene(recipe, 2);
  const RayMap rays = make_ray_map(recipe.camera, 2, 2);
  const cv::Mat made =
      expose(render(scene, rays, {camera_of(recipe, 0)}, 2), recipe.image, 1, 1, 2);
  const cv::Mat committed = image(frame_timestamp_ns(recipe, 0));
  ASSERT_EQ(committed.size(), made.size());
  const auto pixels = static_cast<double>(made.total() * 3);
  EXPECT_LT(cv::norm(made, committed, cv::NORM_L1) / pixels, 4);
}

TEST_F(Desk, CommittedImagesShowTheBoardWhereTheTruthProjectsIt) {
  const Table truth = read_table(folder / kTruthFile);
  for (const std::size_t frame : {0U, 20U, 40U, 59U})
    expect_board(recipe,
                 pose_of(truth.rows[frame]) * recipe.T_body_camera,
                 image(truth.timestamps[frame]),
                 0.1,
                 0.03);
}

}  // namespace
}  // namespace gpo
