// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board_corners.h"

#include "engine/recording/board/board_pose.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::kChessboard;
using test::looking_at;
using test::render_board;
using test::small_lens;
using test::small_pinhole;

double largest_error(const std::vector<Eigen::Vector2d>& corners,
                     const Board& board,
                     const Camera& camera,
                     const Pose& pose) {
  double largest = 0;
  const auto truth = project_board(board, camera, pose);
  for (std::size_t i = 0; i < truth.size(); ++i)
    largest = std::max(largest, (corners[i] - truth[i]).norm());
  return largest;
}

TEST(BoardCorners, AreFoundThroughALens) {
  for (const double tilt : {-35.0, 10.0, 40.0}) {
    const Pose truth = looking_at(kChessboard, 0.35, tilt, 20);
    const auto corners = find_board(render_board(kChessboard, small_lens(), truth), kChessboard);
    ASSERT_EQ(corners.size(), 54U) << tilt;
    EXPECT_LT(largest_error(corners, kChessboard, small_lens(), truth), 0.15) << tilt;
  }
}

TEST(BoardCorners, TellTheTwoEndsByColor) {
  // Whatever way the camera is rolled.
  for (int roll = 0; roll < 360; roll += 45) {
    const Pose truth = looking_at(kChessboard, 0.4, 15, roll);
    const auto corners = find_board(render_board(kChessboard, small_pinhole(), truth), kChessboard);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_LT(largest_error(corners, kChessboard, small_pinhole(), truth), 0.5) << roll;
  }
}

TEST(BoardCorners, OfATwinBeginWhereRowsRunToTheRight) {
  const Board twin{8, 6, 0.025};  // turned by 180 degrees it looks the same
  for (int roll = 0; roll < 360; roll += 40) {
    const Pose truth = looking_at(twin, 0.4, 15, roll);
    const auto corners = find_board(render_board(twin, small_pinhole(), truth), twin);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_GT(corners[7].x(), corners[0].x());
    double nearest = 1e9;
    for (const Pose& symmetry : board_symmetries(twin))
      nearest = std::min(nearest, largest_error(corners, twin, small_pinhole(), symmetry * truth));
    EXPECT_LT(nearest, 0.5) << roll;
  }
}

TEST(BoardCorners, AreNotFoundInOtherImages) {
  EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), kChessboard).empty());
  cv::Mat noise(240, 320, CV_8UC1);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  EXPECT_TRUE(find_board(noise, kChessboard).empty());
  const Board larger{9, 7, 0.025};
  EXPECT_TRUE(
      find_board(render_board(kChessboard, small_pinhole(), looking_at(kChessboard, 0.4, 10, 0)),
                 larger)
          .empty());
}

}  // namespace
}  // namespace gpo
