// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/recording/board/board.h"
#include "tests/engine/recording/board/kalibr_print.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using test::large_lens;
using test::looking_at;

/// Kalibr's grid of 4 x 3 tags, and a single tag.
const Board kGrid{8, 6, 0.05, {}, BoardTags{0.3, 2, {}}};
const Board kTag{2, 2, 0.1, {}, BoardTags{0, 1, 7}};

cv::Mat tag_image(const Board& board, const Pose& pose, bool squares = true) {
  cv::Mat gray = test::render_plane(
      large_lens(), pose, [&](double x, double y) { return test::tag_gray(board, x, y, squares); });
  cv::GaussianBlur(gray, gray, {}, 0.7);
  return gray;
}

test::CornerErrors tag_errors(const std::vector<Eigen::Vector2d>& corners,
                              const Board& board,
                              const Pose& pose) {
  return test::corner_errors(corners, board, large_lens(), pose);
}

TEST(AprilGrid, FindsTheCornersOfKalibrsBoardForAnyRoll) {
  for (const int roll : {0, 45, 100, 190, 280}) {
    const Pose truth = looking_at(kGrid, 0.55, 25, roll);
    const auto [seen, rms_px, largest_px] =
        tag_errors(find_board(tag_image(kGrid, truth), kGrid), kGrid, truth);
    EXPECT_EQ(seen, 48) << roll;
    EXPECT_LT(rms_px, 0.1) << roll;
    EXPECT_LT(largest_px, 0.25) << roll;
    RecordProperty("rms_px_" + std::to_string(roll), std::to_string(rms_px));
  }
}

TEST(AprilGrid, EstimatesThePoseFromPartOfTheBoard) {
  const Pose truth = looking_at(kGrid, 0.55, 20, 10);
  cv::Mat covered = tag_image(kGrid, truth);
  cv::rectangle(covered, {300, 0, 340, 480}, cv::Scalar(60), cv::FILLED);
  const auto corners = find_board(covered, kGrid);
  const auto [seen, rms_px, largest_px] = tag_errors(corners, kGrid, truth);
  EXPECT_GE(seen, 8);
  EXPECT_LE(seen, 28);
  EXPECT_LT(rms_px, 0.1);
  const auto pose = board_pose(corners, kGrid, large_lens());
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->pose.p_wc - truth.p_wc).norm(), 2e-3);
}

TEST(AprilGrid, FindsTagsWithNarrowBordersAndWithoutSquares) {
  Board board = kGrid;
  board.tags->border = 1;
  const Pose truth = looking_at(board, 0.55, 25, 15);
  const auto [seen, rms_px, largest_px] =
      tag_errors(find_board(tag_image(board, truth, false), board), board, truth);
  EXPECT_EQ(seen, 48);
  EXPECT_LT(rms_px, 0.3);
  EXPECT_TRUE(find_board(tag_image(board, truth, false), kGrid).empty()) << "borders of two bits";
}

TEST(AprilGrid, FindsNothingInImagesWithoutTheBoard) {
  EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), kGrid).empty());
  const Pose truth = looking_at(kTag, 0.5, 10, 0);
  EXPECT_TRUE(find_board(tag_image(kTag, truth), kGrid).empty());
}

TEST(AprilTag, EstimatesThePoseFromOneTagWithTheRightNumber) {
  for (const int roll : {0, 90, 200}) {
    const Pose truth = looking_at(kTag, 0.5, 30, roll);
    const cv::Mat gray = tag_image(kTag, truth);
    const auto corners = find_board(gray, kTag);
    ASSERT_EQ(corners.size(), 4U);
    EXPECT_LT(tag_errors(corners, kTag, truth).largest_px, 0.3) << roll;
    const auto pose = board_pose(corners, kTag, large_lens());
    ASSERT_TRUE(pose);
    EXPECT_LT(degrees(so3_log(pose->pose.R_wc.transpose() * truth.R_wc).norm()), 1.0);
    EXPECT_LT((pose->pose.p_wc - truth.p_wc).norm(), 0.01);
    Board other = kTag;
    other.tags->alone = 6;
    EXPECT_TRUE(find_board(gray, other).empty());
    other.tags->alone = BoardTags::kAnyTag;
    EXPECT_EQ(find_board(gray, other).size(), 4U);
  }
}

TEST(AprilGrid, PointsHaveKalibrsSpacingFromTheTopRowDown) {
  const auto points = board_points(kGrid);
  ASSERT_EQ(points.size(), 48U);
  EXPECT_NEAR((points[1] - Eigen::Vector3d(0.05, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((points[2] - Eigen::Vector3d(0.065, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((points[8 * 2 + 3] - Eigen::Vector3d(0.115, 0.065, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(board_symmetries(kGrid).size(), 1U);
  EXPECT_EQ(april_tag_count(), 587);
}

}  // namespace
}  // namespace gpo
