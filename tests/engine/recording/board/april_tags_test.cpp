// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/recording/board/board_corners.h"
#include "engine/recording/board/board_pose.h"
#include "tests/engine/recording/board/kalibr_print.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// Four tags by three, as Kalibr prints them; and one tag.
const Board kGrid{8, 6, 0.05, {}, BoardTags{0.3, 2, {}}};
const Board kTag{2, 2, 0.1, {}, BoardTags{0, 1, 7}};

Camera tag_camera() {
  return {640, 480, 600, 603, 318, 243, Distortion::radial_tangential, {-0.15, 0.04, 1e-3, 5e-4}};
}

/// At the middle of the board's corners.
Pose looking_at_tags(const Board& board, double distance, double tilt_deg, double roll_deg) {
  const Eigen::Vector3d middle = board_points(board).back() / 2;
  const Eigen::Matrix3d R =
      so3_exp({radians(tilt_deg), 0.3 * radians(tilt_deg), 0}) * so3_exp({0, 0, radians(roll_deg)});
  return {R, middle - distance * R.col(2)};
}

cv::Mat tag_image(const Board& board, const Pose& pose, bool squares = true) {
  cv::Mat gray = test::render_plane(
      tag_camera(), pose, [&](double x, double y) { return test::tag_gray(board, x, y, squares); });
  cv::GaussianBlur(gray, gray, {}, 0.7);
  return gray;
}

/// Of the corners that are seen.
struct TagErrors {
  int seen = 0;
  double rms_px = 0;
  double largest_px = 0;
};
TagErrors tag_errors(const std::vector<Eigen::Vector2d>& corners,
                     const Board& board,
                     const Pose& pose) {
  TagErrors result;
  const auto truth = project_board(board, tag_camera(), pose);
  double squares = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (!corners[i].allFinite()) continue;
    ++result.seen;
    const double error = (corners[i] - truth[i]).norm();
    squares += error * error;
    result.largest_px = std::max(result.largest_px, error);
  }
  result.rms_px = std::sqrt(squares / std::max(1, result.seen));
  return result;
}

TEST(AprilGrid, CornersAreThoseOfKalibrsBoardFromAllSides) {
  for (const int roll : {0, 45, 100, 190, 280}) {
    const Pose truth = looking_at_tags(kGrid, 0.55, 25, roll);
    const auto [seen, rms_px, largest_px] =
        tag_errors(find_board(tag_image(kGrid, truth), kGrid), kGrid, truth);
    EXPECT_EQ(seen, 48) << roll;
    EXPECT_LT(rms_px, 0.1) << roll;
    EXPECT_LT(largest_px, 0.25) << roll;
    RecordProperty("rms_px_" + std::to_string(roll), std::to_string(rms_px));
  }
}

TEST(AprilGrid, PartOfTheBoardGivesAPose) {
  const Pose truth = looking_at_tags(kGrid, 0.55, 20, 10);
  cv::Mat covered = tag_image(kGrid, truth);
  cv::rectangle(covered, {300, 0, 340, 480}, cv::Scalar(60), cv::FILLED);
  const auto corners = find_board(covered, kGrid);
  const auto [seen, rms_px, largest_px] = tag_errors(corners, kGrid, truth);
  EXPECT_GE(seen, 8);
  EXPECT_LE(seen, 28);
  EXPECT_LT(rms_px, 0.1);
  const auto pose = board_pose(corners, kGrid, tag_camera());
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->pose.p_wc - truth.p_wc).norm(), 2e-3);
}

TEST(AprilGrid, NarrowBordersWithoutSquaresAreFoundToo) {
  Board board = kGrid;
  board.tags->border = 1;
  const Pose truth = looking_at_tags(board, 0.55, 25, 15);
  const auto [seen, rms_px, largest_px] =
      tag_errors(find_board(tag_image(board, truth, false), board), board, truth);
  EXPECT_EQ(seen, 48);
  EXPECT_LT(rms_px, 0.3);
  EXPECT_TRUE(find_board(tag_image(board, truth, false), kGrid).empty()) << "borders of two bits";
}

TEST(AprilGrid, IsNotFoundInOtherImages) {
  EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), kGrid).empty());
  const Pose truth = looking_at_tags(kTag, 0.5, 10, 0);
  EXPECT_TRUE(find_board(tag_image(kTag, truth), kGrid).empty());
}

TEST(AprilTag, OneTagGivesAPoseAndItsNumberCounts) {
  for (const int roll : {0, 90, 200}) {
    const Pose truth = looking_at_tags(kTag, 0.5, 30, roll);
    const cv::Mat gray = tag_image(kTag, truth);
    const auto corners = find_board(gray, kTag);
    ASSERT_EQ(corners.size(), 4U);
    EXPECT_LT(tag_errors(corners, kTag, truth).largest_px, 0.3) << roll;
    const auto pose = board_pose(corners, kTag, tag_camera());
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

TEST(AprilGrid, PointsAreKalibrsFromTheTopRowOn) {
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
