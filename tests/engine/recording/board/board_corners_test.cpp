// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board/board.h"
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
  return test::corner_errors(corners, board, camera, pose).largest_px;
}

TEST(BoardCorners, FindsAllCornersThroughALens) {
  for (const double tilt : {-35.0, 10.0, 40.0}) {
    const Pose truth = looking_at(kChessboard, 0.35, tilt, 20);
    const auto corners = find_board(render_board(kChessboard, small_lens(), truth), kChessboard);
    ASSERT_EQ(corners.size(), 54U) << tilt;
    EXPECT_LT(largest_error(corners, kChessboard, small_lens(), truth), 0.15) << tilt;
  }
}

TEST(BoardCorners, FirstCornerIsBesideADarkSquareForAnyRoll) {
  for (int roll = 0; roll < 360; roll += 45) {
    const Pose truth = looking_at(kChessboard, 0.4, 15, roll);
    const auto corners = find_board(render_board(kChessboard, small_pinhole(), truth), kChessboard);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_LT(largest_error(corners, kChessboard, small_pinhole(), truth), 0.5) << roll;
  }
}

TEST(BoardCorners, RowsRunToTheRightOnASymmetricBoard) {
  for (int roll = 0; roll < 360; roll += 40) {
    const Pose truth = looking_at(test::kTwin, 0.4, 15, roll);
    const auto corners = find_board(render_board(test::kTwin, small_pinhole(), truth), test::kTwin);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_GT(corners[7].x(), corners[0].x());
    double nearest = 1e9;
    for (const Pose& symmetry : board_symmetries(test::kTwin))
      nearest =
          std::min(nearest, largest_error(corners, test::kTwin, small_pinhole(), symmetry * truth));
    EXPECT_LT(nearest, 0.5) << roll;
  }
}

TEST(BoardCorners, FindsNothingInImagesWithoutTheBoard) {
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
