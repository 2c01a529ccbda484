// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/board/board.h"
#include "engine/truth/truth.h"
#include "tests/engine/recording/board/rendered_board.h"
#include "tests/engine/rotation_error.h"
#include "tests/engine/test_folder.h"

#include <algorithm>
#include <atomic>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using test::kTwin;
using test::looking_at;
using test::rotation_error_deg;
using test::small_pinhole;
using testing::ElementsAre;

/// The camera rolls by 20 deg per frame; frame 2 does not show the board.
Recording rolling_recording(const Board& board, int frames) {
  Recording recording;
  recording.camera = small_pinhole();
  recording.board = board;
  const auto decode = [board](int index) {
    cv::Mat image(240, 320, CV_8UC1, cv::Scalar(90));
    if (index != 2)
      image =
          test::render_board(board, small_pinhole(), looking_at(board, 0.4, 15, 20.0 * index));
    cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
    return image;
  };
  recording.images = std::make_shared<const FrameCache>(frames, decode);
  for (int i = 0; i < frames; ++i) recording.timestamps_ns.push_back(i);
  return recording;
}

TEST(BoardTruth, ReturnsThePosesOfTheRequestedFrames) {
  const Recording recording = rolling_recording(kTwin, 6);
  std::vector<int> seen;
  const auto truth =
      board_truth(recording, 1, 4, {}, [&](int done, int of) { seen.push_back(10 * done + of); });
  EXPECT_EQ(truth.source, "chessboard");
  ASSERT_EQ(truth.poses.size(), 4U);
  EXPECT_FALSE(truth.poses[1]);
  EXPECT_FALSE(truth.uncertainties[1]);
  for (const int i : {0, 2, 3}) {
    ASSERT_TRUE(truth.poses[i]) << i;
    const Pose expected = looking_at(kTwin, 0.4, 15, 20.0 * (i + 1));
    EXPECT_LT(rotation_error_deg(*truth.poses[i], expected), 0.2) << i;
    EXPECT_LT((truth.poses[i]->p_wc - expected.p_wc).norm(), 2e-3) << i;
    EXPECT_LT(truth.uncertainties[i]->position_sigma_m, 1e-3) << i;
  }
  EXPECT_THAT(seen, ElementsAre(15, 25, 35, 45, 55));  // one more for the median of the RMS
}

TEST(BoardTruth, KeepsTheBoardsEndsWhileTheCameraRollsOver) {
  // Only continuity distinguishes the ends of these boards.
  for (const Board& board : {kTwin, Board{5, 5, 0.03}, Board{6, 6, 0.025}}) {
    const auto truth = board_truth(rolling_recording(board, 19), 0, 19);
    for (int i = 0; i < 19; ++i) {
      if (i == 2) continue;
      ASSERT_TRUE(truth.poses[i]) << i;
      const Pose expected = looking_at(board, 0.4, 15, 20.0 * i);
      const Pose first = looking_at(board, 0.4, 15, 0);
      const Eigen::Matrix3d turn = truth.poses[0]->R_wc.transpose() * truth.poses[i]->R_wc;
      const Eigen::Matrix3d expected_turn = first.R_wc.transpose() * expected.R_wc;
      EXPECT_LT(degrees(so3_log(turn.transpose() * expected_turn).norm()), 0.4)
          << board.columns << " " << i;
    }
  }
}

TEST(BoardTruth, StopsAfterTheFramesInWork) {
  const Recording recording = rolling_recording(kTwin, 40);
  std::stop_source stop;
  int frames = 0;
  const auto truth = board_truth(recording, 0, 40, stop.get_token(), [&](int, int) {
    if (++frames == 2) stop.request_stop();
  });
  EXPECT_LE(frames, 2 + static_cast<int>(std::thread::hardware_concurrency()));
  ASSERT_EQ(truth.poses.size(), 40U);
  EXPECT_TRUE(truth.poses[0] || truth.poses[1]);
  EXPECT_FALSE(truth.poses[39]);
}

TEST(BoardTruth, PassesOnDecodingErrors) {
  Recording recording = rolling_recording(kTwin, 6);
  recording.images = std::make_shared<const FrameCache>(6, [](int index) -> cv::Mat {
    if (index == 3) throw InputError("video.mp4: frame 3 cannot be decoded");
    return cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(90));
  });
  EXPECT_EQ(test::error_of([&] { board_truth(recording, 0, 6); }),
            "video.mp4: frame 3 cannot be decoded");
}

TEST(BoardTruth, RejectsFramesThatFitMuchWorseThanTheOthers) {
  Recording recording = rolling_recording(kTwin, 8);
  recording.images = std::make_shared<const FrameCache>(8, [](int index) {
    const Pose pose = looking_at(kTwin, 0.4, 15, 0);
    // Simulates a rolling shutter: the lower rows of frame 5 are 4 px to the right.
    cv::Mat image = test::render_board(kTwin, small_pinhole(), pose);
    if (index == 5) {
      const cv::Mat below = image.rowRange(120, 240);
      const cv::Matx23d shift(1, 0, 4, 0, 1, 0);
      cv::Mat shifted;
      cv::warpAffine(below, shifted, shift, below.size(), cv::INTER_NEAREST, cv::BORDER_REPLICATE);
      shifted.copyTo(below);
    }
    cv::cvtColor(image, image, cv::COLOR_GRAY2BGR);
    return image;
  });
  const auto truth = board_truth(recording, 0, 8);
  EXPECT_FALSE(truth.poses[5]);
  EXPECT_EQ(std::ranges::count(truth.poses, true, [](auto& pose) { return pose.has_value(); }), 7);
  // Without other frames only the limit of 2 px applies.
  const auto alone = board_truth(recording, std::vector<int>{5});
  EXPECT_TRUE(!alone.poses[0] || alone.uncertainties[0]->rms_px > 0.5);
}

TEST(MedianUncertainty, CoversOnlyFramesWithAPose) {
  const std::vector<std::optional<PoseUncertainty>> some = {PoseUncertainty{1, 2, 3, 4},
                                                            std::nullopt,
                                                            PoseUncertainty{9, 1, 7, 5},
                                                            PoseUncertainty{3, 9, 1, 6}};
  const auto median = median_uncertainty(some);
  ASSERT_TRUE(median);
  EXPECT_EQ(median->rms_px, 3);
  EXPECT_EQ(median->position_sigma_m, 2);
  EXPECT_EQ(median->rotation_sigma_deg, 3);
  EXPECT_EQ(median->normal_sigma_deg, 5);
  EXPECT_FALSE(median_uncertainty({}));
}

}  // namespace
}  // namespace gpo
