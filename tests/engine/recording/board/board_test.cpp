// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/truth/truth.h"
#include "tests/engine/recording/board/rendered_board.h"
#include "tests/engine/rotation_error.h"

#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

TEST(BoardCorners, FirstCornerIsBesideADarkSquareForAnyRoll) {
  for (int roll = 0; roll < 360; roll += 45) {
    const Pose truth = looking_at(kChessboard, 0.4, 15, roll);
    const auto corners = find_board(render_board(kChessboard, small_pinhole(), truth), kChessboard);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_LT(corner_errors(corners, kChessboard, small_pinhole(), truth).largest_px, 0.5) << roll;
  }
}

TEST(BoardCorners, RowsRunToTheRightOnASymmetricBoard) {
  for (int roll = 0; roll < 360; roll += 40) {
    const Pose truth = looking_at(kTwin, 0.4, 15, roll);
    const auto corners = find_board(render_board(kTwin, small_pinhole(), truth), kTwin);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_GT(corners[7].x(), corners[0].x());
    double nearest = 1e9;
    for (const Pose& symmetry : board_symmetries(kTwin)) {
      const auto errors = corner_errors(corners, kTwin, small_pinhole(), symmetry * truth);
      nearest = std::min(nearest, errors.largest_px);
    }
    EXPECT_LT(nearest, 0.5) << roll;
  }
}

TEST(BoardCorners, FindsNothingInImagesWithoutTheBoard) {
  EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), kChessboard).empty());
  cv::Mat noise(240, 320, CV_8UC1);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  EXPECT_TRUE(find_board(noise, kChessboard).empty());
  const Pose pose = looking_at(kChessboard, 0.4, 10, 0);
  const cv::Mat smaller = render_board(kChessboard, small_pinhole(), pose);
  EXPECT_TRUE(find_board(smaller, {9, 7, 0.025}).empty());
}

Camera fisheye() {
  return {640, 480, 190, 191, 320, 240, Distortion::equidistant, {0.003, 0.0007, -0.002, 0.0002}};
}

TEST(BoardCorners, AreNotMovedBecauseAWideLensBendsTheirLines) {
  Camera camera = fisheye();
  camera.fx = camera.fy = 280;
  for (const double tilt : {0.0, -25.0, 25.0}) {
    const Pose truth = looking_at(kChessboard, 0.13, tilt, 0);
    const auto corners = find_board(render_board(kChessboard, camera, truth), kChessboard);
    ASSERT_EQ(corners.size(), 54U) << tilt;
    EXPECT_LT(corner_errors(corners, kChessboard, camera, truth).largest_px, 0.5) << tilt;
  }
}

TEST(BoardPose, MatchesTheRenderedPoseThroughALens) {
  for (const double tilt : {-35.0, 10.0, 40.0}) {
    const Pose truth = looking_at(kChessboard, 0.35, tilt, 20);
    const auto corners = find_board(render_board(kChessboard, small_lens(), truth), kChessboard);
    ASSERT_EQ(corners.size(), 54U) << tilt;
    EXPECT_LT(corner_errors(corners, kChessboard, small_lens(), truth).largest_px, 0.15) << tilt;
    const auto found = board_pose(corners, kChessboard, small_lens());
    ASSERT_TRUE(found) << tilt;
    EXPECT_LT(found->uncertainty.rms_px, 0.1);
    EXPECT_LT((found->pose.p_wc - truth.p_wc).norm(), 1e-3) << tilt;
    EXPECT_LT(rotation_error_deg(found->pose, truth), 0.15) << tilt;
  }
}

TEST(BoardPose, IsExactForExactCorners) {
  for (const Camera& camera : {small_lens(), fisheye()}) {
    const Pose truth = looking_at(kChessboard, 0.25, 25, 0);
    const auto exact = board_pose(project_board(kChessboard, camera, truth), kChessboard, camera);
    ASSERT_TRUE(exact);
    EXPECT_LT(exact->uncertainty.rms_px, 1e-6);
    EXPECT_LT((exact->pose.p_wc - truth.p_wc).norm(), 1e-8);
  }
}

TEST(BoardPose, DecidesTheSameInAnImageFourTimesAsLarge) {
  const auto accepted = [](int scale, double noise_px) {
    const Camera camera{.width = 1280 * scale,
                        .height = 960 * scale,
                        .fx = 1000.0 * scale,
                        .fy = 1000.0 * scale,
                        .cx = 640.0 * scale,
                        .cy = 480.0 * scale};
    auto corners = project_board(kChessboard, camera, looking_at(kChessboard, 0.4, 15, 0));
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, noise_px * scale);
    for (Eigen::Vector2d& corner : corners) corner += Eigen::Vector2d(noise(random), noise(random));
    return board_pose(corners, kChessboard, camera).has_value();
  };
  for (const int scale : {1, 4}) {
    EXPECT_TRUE(accepted(scale, 1.2)) << scale;
    EXPECT_FALSE(accepted(scale, 1.8)) << scale;
  }
}

TEST(BoardPose, RejectsCornersThatDoNotFit) {
  auto corners = project_board(kChessboard, small_lens(), looking_at(kChessboard, 0.4, 15, 0));
  corners[20].x() += 40;
  EXPECT_FALSE(board_pose(corners, kChessboard, small_lens()));
}

/// Returns the projected corners with all but `seen` hidden.
std::vector<Eigen::Vector2d> only(const std::vector<int>& seen, const Pose& pose) {
  const auto whole = project_board(kChessboard, small_lens(), pose);
  std::vector<Eigen::Vector2d> corners(
      whole.size(), Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (const int i : seen) corners[i] = whole[i];
  return corners;
}

TEST(BoardPose, NeedsSixCornersThatAreNotCollinear) {
  const Pose truth = looking_at(kChessboard, 0.4, 25, 30);
  const auto six = board_pose(only({0, 1, 2, 9, 10, 20}, truth), kChessboard, small_lens());
  ASSERT_TRUE(six);
  EXPECT_LT((six->pose.p_wc - truth.p_wc).norm(), 1e-6);
  EXPECT_FALSE(board_pose(only({0, 1, 2, 9, 10}, truth), kChessboard, small_lens()));
  EXPECT_FALSE(board_pose(only({0, 1, 2, 3, 4, 5, 6, 7, 8}, truth), kChessboard, small_lens()));
  EXPECT_FALSE(board_pose(only({0, 1, 2, 3, 4, 5, 6, 7, 8, 22}, truth), kChessboard, small_lens()));
  EXPECT_FALSE(board_pose(only({0, 10, 20, 30, 40, 50}, truth), kChessboard, small_lens()));
}

/// Returns the mean (error / sigma)^2 of position, rotation and normal over many noise samples.
Eigen::Vector3d mean_normalized_squares(const Camera& camera, const Pose& truth) {
  constexpr int kSeeds = 400;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.3);
    auto corners = project_board(kChessboard, camera, truth);
    for (auto& corner : corners) corner += Eigen::Vector2d(noise(random), noise(random));
    const auto found = board_pose(corners, kChessboard, camera);
    if (!found) return Eigen::Vector3d::Zero();
    const PoseUncertainty& u = found->uncertainty;
    const double position = (found->pose.p_wc - truth.p_wc).norm();
    const double normal =
        angle_deg(found->pose.R_wc.transpose().col(2), truth.R_wc.transpose().col(2));
    sum += Eigen::Vector3d(position / u.position_sigma_m,
                           rotation_error_deg(found->pose, truth) / u.rotation_sigma_deg,
                           normal / u.normal_sigma_deg)
               .cwiseAbs2();
  }
  return sum / kSeeds;
}

TEST(BoardPose, UncertaintyMatchesTheErrors) {
  for (const Camera& camera : {small_lens(), fisheye()}) {
    const Eigen::Vector3d mean =
        mean_normalized_squares(camera, looking_at(kChessboard, 0.3, 35, 20));
    ASSERT_TRUE(mean.allFinite());
    EXPECT_GT(mean.minCoeff(), 0.8) << mean.transpose();
    EXPECT_LT(mean.maxCoeff(), 1.25) << mean.transpose();
  }
}

TEST(BoardSymmetries, MapTheBoardOntoItselfWithItsColors) {
  const auto count = [](const Board& board) { return board_symmetries(board).size(); };
  EXPECT_EQ(count(kChessboard), 1U);
  for (const Board& board : {kTwin, Board{7, 5, 0.025}, Board{5, 5, 0.025}})
    EXPECT_EQ(count(board), 2U);
  EXPECT_EQ(count({6, 6, 0.025}), 4U);
  EXPECT_EQ(count({6, 6, 0.025, BoardMarkers{0.02, "DICT_4X4_50"}}), 1U);
  for (const Board& board : {Board{8, 6, 0.025}, Board{5, 5, 0.03}, Board{6, 6, 0.03}})
    for (const Pose& symmetry : board_symmetries(board))
      for (double x = -0.0131; x < 0.2; x += 0.011)
        for (double y = -0.0172; y < 0.2; y += 0.013) {
          const Eigen::Vector3d turned = to_world(symmetry, {x, y, 0});
          EXPECT_EQ(board_gray(board, x, y), board_gray(board, turned.x(), turned.y()));
        }
}

}  // namespace
}  // namespace gpo::test
