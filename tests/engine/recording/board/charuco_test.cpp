// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause

#include "engine/recording/board/board.h"
#include "tests/engine/recording/board/opencv_print.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using test::large_lens;
using test::looking_at;
using test::opencv_charuco;
using test::render_print;

const Board kCharuco{7, 5, 0.03, BoardMarkers{0.022, "DICT_5X5_100"}};

test::CornerErrors compare(const std::vector<Eigen::Vector2d>& corners, const Pose& pose) {
  return test::corner_errors(corners, kCharuco, large_lens(), pose);
}

cv::Mat image(const Pose& pose, const cv::Mat& print) {
  return render_print(print, kCharuco, large_lens(), pose);
}

TEST(Charuco, FindsTheCornersOfOpenCvsBoardForAnyRoll) {
  const cv::Mat print = opencv_charuco(kCharuco, cv::aruco::DICT_5X5_100);
  for (const int roll : {0, 100, 190, 280}) {
    const Pose truth = looking_at(kCharuco, 0.45, 25, roll);
    const auto [seen, rms_px, largest_px] =
        compare(find_board(image(truth, print), kCharuco), truth);
    EXPECT_GE(seen, 30) << roll;
    EXPECT_LT(largest_px, 0.25) << roll;
  }
}

TEST(Charuco, EstimatesThePoseFromPartOfTheBoard) {
  const Pose truth = looking_at(kCharuco, 0.45, 20, 10);
  cv::Mat covered = image(truth, opencv_charuco(kCharuco, cv::aruco::DICT_5X5_100));
  cv::rectangle(covered, {300, 0, 340, 480}, cv::Scalar(60), cv::FILLED);
  const auto corners = find_board(covered, kCharuco);
  const auto [seen, rms_px, largest_px] = compare(corners, truth);
  EXPECT_GE(seen, 8);
  EXPECT_LE(seen, 25);
  EXPECT_LT(largest_px, 0.25);
  const auto pose = board_pose(corners, kCharuco, large_lens());
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->pose.p_wc - truth.p_wc).norm(), 3e-3);
  EXPECT_LT((pose->pose.p_wc - truth.p_wc).norm(), 4 * pose->uncertainty.position_sigma_m);
}

/// Draws a board with an even number of rows as OpenCV did before 4.6.
cv::Mat older_print() {
  constexpr int kTexels = 60;
  constexpr int kMarker = 44;
  cv::Mat print(
      kTexels * (kCharuco.rows + 1), kTexels * (kCharuco.columns + 1), CV_8U, cv::Scalar(0));
  int id = 0;
  for (int row = 0; row <= kCharuco.rows; ++row) {
    for (int column = row % 2; column <= kCharuco.columns; column += 2) {
      cv::Mat square = print({kTexels * column, kTexels * row, kTexels, kTexels});
      square.setTo(255);
      test::opencv_marker(cv::aruco::DICT_5X5_100, id++, kMarker)
          .copyTo(square({8, 8, kMarker, kMarker}));
    }
  }
  return print;
}

TEST(Charuco, FindsOlderBoardsWithAnEvenNumberOfRows) {
  const Pose truth = looking_at(kCharuco, 0.45, 25, 5);
  const auto [seen, rms_px, largest_px] =
      compare(find_board(image(truth, older_print()), kCharuco), truth);
  EXPECT_GE(seen, 30);
  EXPECT_LT(largest_px, 0.25);
}

TEST(Charuco, FindsNothingInImagesWithoutTheBoard) {
  EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), kCharuco).empty());
  const Board plain{9, 6, 0.025};
  EXPECT_TRUE(
      find_board(test::render_board(plain, large_lens(), looking_at(plain, 0.4, 10, 0)), kCharuco)
          .empty());
}

TEST(Charuco, KnowsDictionariesByNameWithAndWithoutPrefix) {
  EXPECT_EQ(dictionary_name("DICT_5X5_100"), "DICT_5X5_100");
  EXPECT_EQ(dictionary_name("5x5_100"), "DICT_5X5_100");
  EXPECT_EQ(dictionary_name("APRILTAG_36h11"), "DICT_APRILTAG_36h11");
  EXPECT_FALSE(dictionary_name("5X5_99"));
  EXPECT_FALSE(dictionary_name(""));
  EXPECT_EQ(dictionary_size("DICT_5X5_100"), 100);
  EXPECT_EQ(dictionary_size("DICT_APRILTAG_16h5"), 30);
  EXPECT_EQ(marker_count(kCharuco), 24);
  EXPECT_EQ(marker_count({6, 4, 0.03, BoardMarkers{0.02, "DICT_4X4_50"}}), 17);
}

}  // namespace
}  // namespace gpo
