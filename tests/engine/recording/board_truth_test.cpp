// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/board_truth.h"

#include "rendered_board.h"
#include "test_folder.h"

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using test::looking_at;
using test::render_board;

const Board kBoard{9, 6, 0.025};  // its two ends differ in color
const Board kTwin{8, 6, 0.025};   // turned by 180 degrees it looks the same

Camera pinhole() { return {320, 240, 300, 302, 158.5, 121.5, Distortion::none, {}}; }
Camera lens() {
  return {
      320, 240, 300, 302, 158.5, 121.5, Distortion::radial_tangential, {-0.2, 0.05, 1e-3, 5e-4}};
}

double largest_corner_error(const std::vector<Eigen::Vector2d>& corners,
                            const Board& board,
                            const Camera& camera,
                            const Pose& pose) {
  double largest = 0;
  const auto points = board_points(board);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d truth = project(camera, to_camera(pose, points[i]));
    largest = std::max(largest, (corners[i] - truth).norm());
  }
  return largest;
}

double rotation_error_deg(const Pose& a, const Pose& b) {
  return degrees(so3_log(a.R_wc.transpose() * b.R_wc).norm());
}

TEST(BoardTruth, FindsCornersAndPoseThroughALens) {
  for (const double tilt : {-35.0, 10.0, 40.0}) {
    const Pose truth = looking_at(kBoard, 0.35, tilt, 20);
    const auto corners = find_board(render_board(kBoard, lens(), truth), kBoard);
    ASSERT_EQ(corners.size(), 54U) << tilt;
    EXPECT_LT(largest_corner_error(corners, kBoard, lens(), truth), 0.15) << tilt;
    const auto found = board_pose(corners, kBoard, lens());
    ASSERT_TRUE(found) << tilt;
    EXPECT_LT(found->rms_px, 0.1);
    EXPECT_LT((found->pose.p_wc - truth.p_wc).norm(), 1e-3) << tilt;
    EXPECT_LT(rotation_error_deg(found->pose, truth), 0.15) << tilt;
  }
}

TEST(BoardTruth, TellsTheTwoEndsByColor) {
  // Whatever way the camera is rolled, and without a previous frame.
  for (int roll = 0; roll < 360; roll += 45) {
    const Pose truth = looking_at(kBoard, 0.4, 15, roll);
    const auto corners = find_board(render_board(kBoard, pinhole(), truth), kBoard);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_LT(largest_corner_error(corners, kBoard, pinhole(), truth), 0.5) << roll;
  }
}

TEST(BoardTruth, KeepsTheOrderWhileTheCameraRolls) {
  std::vector<Eigen::Vector2d> previous;
  for (int roll = 0; roll <= 360; roll += 30) {
    const Pose truth = looking_at(kTwin, 0.4, 15, roll);
    const auto corners = find_board(render_board(kTwin, pinhole(), truth), kTwin, previous);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_LT(largest_corner_error(corners, kTwin, pinhole(), truth), 0.5) << roll;
    previous = corners;
  }
}

TEST(BoardTruth, KeepsTheOrderOfASquareBoard) {
  const Board board{5, 5, 0.03};
  std::vector<Eigen::Vector2d> previous;
  for (int roll = 0; roll <= 360; roll += 30) {
    const Pose truth = looking_at(board, 0.4, 15, roll);
    const auto corners = find_board(render_board(board, pinhole(), truth), board, previous);
    ASSERT_FALSE(corners.empty()) << roll;
    EXPECT_LT(largest_corner_error(corners, board, pinhole(), truth), 0.5) << roll;
    previous = corners;
  }
}

TEST(BoardTruth, FindsNoneInOtherPictures) {
  EXPECT_TRUE(find_board(cv::Mat(240, 320, CV_8UC1, cv::Scalar(128)), kBoard).empty());
  cv::Mat noise(240, 320, CV_8UC1);
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, 0, 256);
  EXPECT_TRUE(find_board(noise, kBoard).empty());
  const Board larger{9, 7, 0.025};
  EXPECT_TRUE(
      find_board(render_board(kBoard, pinhole(), looking_at(kBoard, 0.4, 10, 0)), larger).empty());
}

TEST(BoardTruth, GivesNoPoseForCornersThatDoNotFit) {
  const Pose truth = looking_at(kBoard, 0.4, 15, 0);
  std::vector<Eigen::Vector2d> corners;
  for (const auto& point : board_points(kBoard)) {
    corners.push_back(project(lens(), to_camera(truth, point)));
  }
  const auto exact = board_pose(corners, kBoard, lens());
  ASSERT_TRUE(exact);
  EXPECT_LT(exact->rms_px, 1e-6);
  EXPECT_LT((exact->pose.p_wc - truth.p_wc).norm(), 1e-8);
  corners[20].x() += 40;
  EXPECT_FALSE(board_pose(corners, kBoard, lens()));
  corners.pop_back();
  EXPECT_FALSE(board_pose(corners, kBoard, lens()));
}

/// Frame 2 does not show the board.
Recording rolling_recording() {
  Recording recording;
  recording.camera = pinhole();
  recording.board = kTwin;
  const auto decode = [](int index) {
    cv::Mat picture(240, 320, CV_8UC1, cv::Scalar(90));
    if (index != 2) {
      picture = render_board(kTwin, pinhole(), looking_at(kTwin, 0.4, 15, 20.0 * index));
    }
    cv::cvtColor(picture, picture, cv::COLOR_GRAY2BGR);
    return picture;
  };
  recording.pictures = std::make_shared<const FrameCache>(6, decode);
  for (int i = 0; i < 6; ++i) recording.timestamps_ns.push_back(i);
  return recording;
}

TEST(BoardTruth, GivesThePosesOfTheFramesAskedFor) {
  const Recording recording = rolling_recording();
  std::vector<int> seen;
  const auto truth =
      board_truth(recording, 1, 4, {}, [&](int done, int of) { seen.push_back(10 * done + of); });
  ASSERT_EQ(truth.poses.size(), 4U);
  EXPECT_FALSE(truth.poses[1]);
  for (const int i : {0, 2, 3}) {
    ASSERT_TRUE(truth.poses[i]) << i;
    const Pose expected = looking_at(kTwin, 0.4, 15, 20.0 * (i + 1));
    EXPECT_LT(rotation_error_deg(*truth.poses[i], expected), 0.2) << i;
    EXPECT_LT((truth.poses[i]->p_wc - expected.p_wc).norm(), 2e-3) << i;
  }
  EXPECT_EQ(seen, (std::vector<int>{14, 24, 34, 44}));
}

TEST(BoardTruth, StopsAtTheNextFrame) {
  const Recording recording = rolling_recording();
  std::stop_source stop;
  int frames = 0;
  const auto truth = board_truth(recording, 0, 6, stop.get_token(), [&](int, int) {
    if (++frames == 2) stop.request_stop();
  });
  EXPECT_EQ(frames, 2);
  ASSERT_EQ(truth.poses.size(), 6U);
  EXPECT_TRUE(truth.poses[1]);
  EXPECT_FALSE(truth.poses[3]);
}

}  // namespace
}  // namespace gpo
