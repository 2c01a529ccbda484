// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/synthesis/small_recipe.h"

#include "engine/files/text_file.h"
#include "engine/synthesis/synthesize.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>
#include <unistd.h>

namespace gpo {

namespace {

std::string with_replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos) throw std::logic_error("not in the recipe: " + from);
  return text.replace(place, from.size(), to);
}

}  // namespace

std::string small_recipe_text() {
  return R"(seed: 3
camera:
  resolution: [160, 120]
  intrinsics: [125, 124, 80.4, 59.2]
  distortion_model: radial-tangential
  distortion_coefficients: [0.1, -0.2, 0.001, -0.001]
  T_BS: [0, -1, 0, 0.02, -1, 0, 0, 0.06, 0, 0, -1, -0.004, 0, 0, 0, 1]
frames: {count: 4, rate: 30, start_ns: 5000000000}
trajectory:
  position:
    start: [-0.05, -0.35, 0.42]
    end: [0.03, -0.35, 0.42]
    harmonics:
      - {amplitude: [0.01, 0.02, 0.015], frequency: 1.1, phase: 30}
  look_at: {start: [0, 0, 0], end: [0.02, 0.01, 0]}
  roll: {start: [-2], end: [3]}
desk:
  size: [0.7, 0.6]
  texture_seed: 5
  board: {columns: 5, rows: 4, square: 0.03, margin: 0.01, center: [0, 0], angle: 8}
  prints:
    - {kind: card, center: [0.2, 0.1], size: [0.06, 0.09], angle: 20}
  boxes:
    - {kind: cube, center: [-0.18, 0.1], size: [0.06, 0.06, 0.06], angle: 30}
picture: {format: png, samples: 2, noise: 1, blur: 0.5, gain_variation: 0.02, exposure: 0.004}
gyroscope:
  rate: 200
  noise_density: 0.0002
  bias: [0.006, -0.004, 0.003]
  calibrated_bias: [0.0065, -0.0045, 0.0033]
)";
}

std::string small_recipe_with(const std::string& from, const std::string& to) {
  return with_replaced(small_recipe_text(), from, to);
}

std::filesystem::path small_room(double readout_s) {
  namespace fs = std::filesystem;
  std::string text = read_file(GPO_SOURCE_DIR "/sequences/companions/corner.yaml");
  for (const auto& [from, to] : {
           std::pair<std::string, std::string>{"[640, 480]", "[320, 240]"},
           {"[498.2, 497.6, 322.4, 238.1]", "[249.1, 248.8, 160.95, 118.8]"},
           {"count: 90", "count: 60"},
           {"samples: 3 ", "samples: 2 "},
           {"  exposure:", "  rolling_shutter: " + std::to_string(readout_s) + "\n  exposure:"},
       })
    text = with_replaced(text, from, to);
  const fs::path folder = fs::path(GPO_TEST_OUTPUT_DIR) / "rooms";
  const fs::path recipe =
      folder / ("room-" + std::to_string(std::hash<std::string>{}(text)) + ".yaml");
  fs::create_directories(folder);
  // Renamed when complete, for tests that start at the same time.
  const fs::path mine = recipe.string() + std::to_string(getpid());
  std::ofstream(mine) << text;
  fs::rename(mine, recipe);
  return synthesized_recordings(std::span(&recipe, 1), folder, 2).front();
}

std::filesystem::path test_folder(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  auto folder = std::filesystem::path(GPO_TEST_OUTPUT_DIR) / "synthesis" /
                (std::string(test->test_suite_name()) + "." + test->name()) / name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder;
}

std::map<std::string, std::string> folder_contents(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[std::filesystem::relative(entry.path(), folder).string()] = read_file(entry.path());
  return files;
}

Recipe recipe_of(const std::string& text) {
  const auto file = test_folder("recipe") / "small.yaml";
  std::ofstream(file) << text;
  return read_recipe(file);
}

Pose camera_of(const Recipe& recipe, int frame) {
  const double t = trajectory_seconds(recipe, frame_timestamp_ns(recipe, frame));
  return camera_motion(recipe.trajectory, t).pose;
}

std::vector<Eigen::Vector2d> corner_errors(const cv::Mat& image,
                                           const std::vector<Eigen::Vector2d>& projections,
                                           int half_window) {
  std::vector<cv::Point2f> corners;
  for (const auto& px : projections) {
    corners.emplace_back(static_cast<float>(px.x()), static_cast<float>(px.y()));
    EXPECT_TRUE(cv::Rect({}, image.size()).contains(corners.back())) << corners.back();
  }
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-4);
  cv::cornerSubPix(gray, corners, {half_window, half_window}, {-1, -1}, criteria);
  std::vector<Eigen::Vector2d> errors;
  for (std::size_t i = 0; i < corners.size(); ++i)
    errors.push_back(Eigen::Vector2d(corners[i].x, corners[i].y) - projections[i]);
  return errors;
}

void expect_board(const Recipe& recipe,
                  const Pose& pose,
                  const cv::Mat& image,
                  double most_rms,
                  double most_mean) {
  std::vector<Eigen::Vector2d> projections;
  for (const Eigen::Vector3d& corner : board_corners(*recipe.desk.board))
    projections.push_back(project(recipe.camera, to_camera(pose, corner)));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0;
  for (const Eigen::Vector2d& error : corner_errors(image, projections, 8)) {
    sum += error;
    squares += error.squaredNorm();
  }
  const auto n = static_cast<double>(projections.size());
  EXPECT_LT(std::sqrt(squares / n), most_rms);
  EXPECT_LT(sum.norm() / n, most_mean);
}

}  // namespace gpo
