// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/recording/board/rendered_board.h"

#include <gtest/gtest.h>
#include <opencv2/core/version.hpp>
#include <opencv2/imgproc.hpp>

#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
#include <opencv2/objdetect/aruco_board.hpp>
#include <opencv2/objdetect/aruco_dictionary.hpp>
#else
#include <opencv2/aruco/charuco.hpp>
#endif

namespace gpo::test {
namespace {

constexpr int kTexels = 60;  // side of a square in a print of a ChArUco board [px]
const Board kCharuco{7, 5, 0.03, BoardMarkers{0.022, "DICT_5X5_100"}};
/// Kalibr's grid of 4 x 3 tags, and a single tag.
const Board kGrid{8, 6, 0.05, {}, BoardTags{0.3, 2, {}}};
const Board kTag{2, 2, 0.1, {}, BoardTags{0, 1, 7}};

/// Draws a board with an even number of rows as OpenCV does, and as it did before 4.6.
cv::Mat charuco_print() {
  const cv::Size squares(kCharuco.columns + 1, kCharuco.rows + 1);
  const auto square = static_cast<float>(kCharuco.square_m);
  const auto marker = static_cast<float>(kCharuco.markers->side_m);
  const auto markers = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  cv::Mat print;
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
  cv::aruco::CharucoBoard(squares, square, marker, markers)
      .generateImage(squares * kTexels, print, 0, 1);
#else
  cv::aruco::CharucoBoard::create(squares.width, squares.height, square, marker, markers)
      ->draw(squares * kTexels, print, 0, 1);
#endif
  return print;
}
cv::Mat older_charuco_print() {
  constexpr int kMarker = 44;
  const cv::Size squares(kCharuco.columns + 1, kCharuco.rows + 1);
  cv::Mat print(squares * kTexels, CV_8U, cv::Scalar(0));
  const auto markers = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_100);
  cv::Mat marker;
  int id = 0;
  for (int row = 0; row < squares.height; ++row) {
    for (int column = row % 2; column < squares.width; column += 2) {
      cv::Mat square = print({kTexels * column, kTexels * row, kTexels, kTexels});
      square.setTo(255);
#if CV_VERSION_MAJOR * 100 + CV_VERSION_MINOR >= 407
      markers.generateImageMarker(id++, kMarker, marker, 1);
#else
      markers->drawMarker(id++, kMarker, marker, 1);
#endif
      marker.copyTo(square({8, 8, kMarker, kMarker}));
    }
  }
  return print;
}

cv::Mat tag_image(const Board& board, const Pose& pose, bool squares = true) {
  cv::Mat gray = render_plane(
      large_lens(), pose, [&](double x, double y) { return tag_gray(board, x, y, squares); });
  cv::GaussianBlur(gray, gray, {}, 0.7);
  return gray;
}

CornerErrors errors_of(const std::vector<Eigen::Vector2d>& corners,
                       const Board& board,
                       const Pose& pose) {
  return corner_errors(corners, board, large_lens(), pose);
}

cv::Mat charuco_image(const Pose& pose, const cv::Mat& print) {
  return render_print(print, kCharuco, large_lens(), pose);
}

TEST(Charuco, FindsTheCornersOfCurrentAndOlderBoardsOfOpenCvForAnyRoll) {
  for (const int roll : {0, 5, 100, 190, 280}) {
    const cv::Mat print = roll == 5 ? older_charuco_print() : charuco_print();
    const Pose truth = looking_at(kCharuco, 0.45, 25, roll);
    const auto [seen, rms_px, largest_px] =
        errors_of(find_board(charuco_image(truth, print), kCharuco), kCharuco, truth);
    EXPECT_GE(seen, 30) << roll;
    EXPECT_LT(largest_px, 0.25) << roll;
  }
}

TEST(Markers, DetermineThePoseFromPartOfTheBoard) {
  for (const Board& board : {kCharuco, kGrid}) {
    const bool grid = board.tags.has_value();
    const Pose truth = looking_at(board, grid ? 0.55 : 0.45, 20, 10);
    cv::Mat covered = grid ? tag_image(board, truth) : charuco_image(truth, charuco_print());
    cv::rectangle(covered, {300, 0, 340, 480}, cv::Scalar(60), cv::FILLED);
    const auto corners = find_board(covered, board);
    const auto [seen, rms_px, largest_px] = errors_of(corners, board, truth);
    EXPECT_GE(seen, 8) << grid;
    EXPECT_LE(seen, grid ? 28 : 25);
    EXPECT_LT(grid ? rms_px : largest_px, grid ? 0.1 : 0.25);
    const auto pose = board_pose(corners, board, large_lens());
    ASSERT_TRUE(pose) << grid;
    const double error_m = (pose->pose.p_wc - truth.p_wc).norm();
    EXPECT_LT(error_m, 3e-3);
    EXPECT_LT(error_m, grid ? 2e-3 : 4 * pose->uncertainty.position_sigma_m);
  }
}

TEST(Markers, FindNothingInImagesWithoutTheBoard) {
  for (const Board& board : {kCharuco, kGrid})
    EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), board).empty());
  const Board plain{9, 6, 0.025};
  const Pose pose = looking_at(plain, 0.4, 10, 0);
  EXPECT_TRUE(find_board(render_board(plain, large_lens(), pose), kCharuco).empty());
  EXPECT_TRUE(find_board(tag_image(kTag, looking_at(kTag, 0.5, 10, 0)), kGrid).empty());
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

TEST(AprilGrid, FindsTheCornersOfKalibrsBoardForAnyRoll) {
  for (const int roll : {0, 45, 100, 190, 280}) {
    const Pose truth = looking_at(kGrid, 0.55, 25, roll);
    const auto [seen, rms_px, largest_px] =
        errors_of(find_board(tag_image(kGrid, truth), kGrid), kGrid, truth);
    EXPECT_EQ(seen, 48) << roll;
    EXPECT_LT(rms_px, 0.1) << roll;
    EXPECT_LT(largest_px, 0.25) << roll;
    RecordProperty("rms_px_" + std::to_string(roll), std::to_string(rms_px));
  }
}

TEST(AprilGrid, FindsTagsWithNarrowBordersAndWithoutSquares) {
  Board board = kGrid;
  board.tags->border = 1;
  const Pose truth = looking_at(board, 0.55, 25, 15);
  const auto [seen, rms_px, largest_px] =
      errors_of(find_board(tag_image(board, truth, false), board), board, truth);
  EXPECT_EQ(seen, 48);
  EXPECT_LT(rms_px, 0.3);
  EXPECT_TRUE(find_board(tag_image(board, truth, false), kGrid).empty()) << "borders of two bits";
}

TEST(AprilTag, EstimatesThePoseFromOneTagWithTheRightNumber) {
  for (const int roll : {0, 90, 200}) {
    const Pose truth = looking_at(kTag, 0.5, 30, roll);
    const cv::Mat gray = tag_image(kTag, truth);
    const auto corners = find_board(gray, kTag);
    ASSERT_EQ(corners.size(), 4U);
    EXPECT_LT(errors_of(corners, kTag, truth).largest_px, 0.3) << roll;
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
}  // namespace gpo::test
