// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/repetition.h"

#include "engine/tracking/tracker.h"
#include "tests/engine/desk.h"

#include <limits>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

using Eigen::Matrix2Xd, Eigen::Vector2d, Eigen::VectorXd;

constexpr int kPeriod_px = 40;
const cv::Size kImage(480, 360);
const Camera kTileCamera{kImage.width, kImage.height, 400, 400, 240, 180, Distortion::none, {}};

/// How the marbling of tiles differs.
enum class Marbling { one_for_all, own };

/// Returns tiles with grout, larger than an image, CV_8UC1.
cv::Mat tiles(Marbling marbling) {
  cv::RNG random(5);
  cv::Mat marble(900, 1200, CV_32F);
  random.fill(marble, cv::RNG::NORMAL, 0, 50);
  cv::GaussianBlur(marble, marble, {}, 2);
  const cv::Mat one = marble(cv::Rect(0, 0, kPeriod_px, kPeriod_px)).clone();
  cv::Mat floor(marble.size(), CV_8UC1);
  for (int v = 0; v < floor.rows; v += 1)
    for (int u = 0; u < floor.cols; ++u) {
      const int row = v % kPeriod_px, column = u % kPeriod_px;
      const bool grout = row < 4 || column < 4;
      const float own =
          marbling == Marbling::own ? marble.at<float>(v, u) : one.at<float>(row, column);
      floor.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(grout ? 90 : 180 + own);
    }
  return floor;
}

/// Returns the image in which the texture has moved by whole pixels, with noise.
cv::Mat moved(const cv::Mat& floor, const cv::Point& by, int seed) {
  cv::RNG random(seed);
  cv::Mat noise(kImage, CV_32F), gray;
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::add(floor(cv::Rect(cv::Point(400, 300) - by, kImage)), noise, gray, {}, CV_8U);
  return gray;
}

TEST(Repetition, IsFoundInTilesAndNotOnADesk) {
  for (const Marbling marbling : {Marbling::one_for_all, Marbling::own}) {
    const cv::Mat gray = moved(tiles(marbling), {0, 0}, 1);
    const Matrix2Xd corners = detect_corners(gray);
    const auto repetition = find_repetition(smoothed_pyramid(gray), corners);
    ASSERT_TRUE(repetition);
    ASSERT_EQ(repetition->period_px.cols(), corners.cols());
    for (const auto& period_px : repetition->period_px.colwise())
      EXPECT_NEAR(period_px.norm(), kPeriod_px, 3);
  }
  const cv::Mat gray = desk()->images->gray(0);
  EXPECT_FALSE(find_repetition(smoothed_pyramid(gray), detect_corners(gray)));
  const cv::Mat uniform(kImage, CV_8UC1, cv::Scalar(128));
  EXPECT_FALSE(find_repetition(smoothed_pyramid(uniform), Matrix2Xd(2, 0)));
  EXPECT_FALSE(find_repetition(smoothed_pyramid(uniform), Vector2d(240, 180)));
}

struct Step {
  Matrix2Xd flow_px;
  double margin;
};

Step step(Marbling marbling, const cv::Point& by, const Vector2d& predicted_px) {
  const cv::Mat floor = tiles(marbling);
  const cv::Mat before = moved(floor, {0, 0}, 1);
  const Matrix2Xd corners = detect_corners(before);
  const RepeatedFlow flow = repeated_flow(smoothed_pyramid(before),
                                          smoothed_pyramid(moved(floor, by, 2)),
                                          corners,
                                          predicted_px.replicate(1, corners.cols()),
                                          VectorXd::Constant(corners.cols(), kPeriod_px));
  return {flow.px, flow.margin};
}

/// Returns the share of tracks within 1.5 px of a motion.
double share_at(const Step& step, const Vector2d& motion_px) {
  const auto off_px = (step.flow_px.colwise() - motion_px).colwise().norm();
  return static_cast<double>((off_px.array() < 1.5).count()) /
         static_cast<double>(step.flow_px.cols());
}

TEST(RepeatedFlow, DistinguishesTilesByTheirMarbling) {
  for (const cv::Point& by : {cv::Point(9, 4), cv::Point(-26, 17), cv::Point(44, -3)}) {
    const Step found = step(Marbling::own, by, {0, 0});
    EXPECT_GT(share_at(found, {by.x, by.y}), 0.9) << by;
    EXPECT_GT(found.margin, kDistinctMotion) << by;
  }
}

TEST(RepeatedFlow, FollowsThePredictionOverEqualTilesAndHasNoMargin) {
  const cv::Point by(26, 0);
  for (const int periods : {0, 1}) {
    const Vector2d alias_px(by.x - periods * kPeriod_px, 0);
    const Step found = step(Marbling::one_for_all, by, alias_px + Vector2d(6, -5));
    EXPECT_GT(share_at(found, alias_px), 0.9) << periods;
    EXPECT_LT(found.margin, kDistinctMotion) << periods;
  }
}

/// Places of all tracks over frames that each move by `by`.
Tracks tracked(Marbling marbling, const cv::Point& by, int frames) {
  const cv::Mat floor = tiles(marbling);
  return *track_window([&](int i) { return moved(floor, i * by, i + 1); },
                       kTileCamera,
                       {0, frames},
                       Tracking::anchored);
}

TEST(Repetition, DoesNotMakeTracksJump) {
  for (const cv::Point& by : {cv::Point(3, 1), cv::Point(13, 7), cv::Point(-23, 2)}) {
    constexpr int kFrames = 8;
    const Tracks tracks = tracked(Marbling::own, by, kFrames);
    ASSERT_TRUE(tracks.repetition);
    EXPECT_TRUE(ambiguous_frames(*tracks.repetition).empty()) << by;
    int living = 0;
    for (int j = 0; j < tracks.track_count(); ++j) {
      if (!tracks.seen(kFrames - 1, j)) continue;
      ++living;
      const Vector2d motion_px = tracks.raw_px[kFrames - 1].col(j) - tracks.raw_px[0].col(j);
      EXPECT_LT((motion_px - (kFrames - 1) * Vector2d(by.x, by.y)).norm(), 0.3) << by << ", " << j;
    }
    EXPECT_GT(living, 0.4 * tracks.track_count()) << by;
  }
}

TEST(Repetition, IsAmbiguousIfTilesAreEqual) {
  const Tracks tracks = tracked(Marbling::one_for_all, {26, 0}, 5);
  ASSERT_TRUE(tracks.repetition);
  EXPECT_EQ(ambiguous_frames(*tracks.repetition), (std::vector<int>{1, 2, 3, 4}));
}

TEST(Repetition, IsNotAmbiguousBesideADistinctMotion) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  const auto frames = [](std::vector<double> margins) {
    return ambiguous_frames({Matrix2Xd(2, 0), std::move(margins)});
  };
  EXPECT_EQ(frames({kNone, 5, 1, 5, 5, 1, 1, 5}), std::vector<int>{});
  EXPECT_EQ(frames({kNone, 1, 1, 5}), std::vector<int>{1});
  EXPECT_EQ(frames({kNone, 5, 1, -2, 1}), (std::vector<int>{3, 4}));
  EXPECT_EQ(frames({kNone, 1, kNone, 1}),
            (std::vector<int>{1, 3}));  // other motions left the image
  EXPECT_EQ(frames({kNone}), std::vector<int>{});
}

TEST(Repetition, KeepsTheLeastMarginOfFramesThatAreDropped) {
  const cv::Mat floor = tiles(Marbling::own);
  WindowTracker tracker(kTileCamera, Tracking::anchored);
  for (int i = 0; i < 6; ++i) tracker.add(moved(floor, i * cv::Point(6, 2), i + 1));
  const std::vector<double> all = tracker.tracks().repetition->margins;
  tracker.drop_every_second();
  const std::vector<double>& kept = tracker.tracks().repetition->margins;
  EXPECT_EQ(
      kept,
      (std::vector<double>{all[0], std::min(all[1], all[2]), std::min(all[3], all[4]), all[5]}));
}

}  // namespace
}  // namespace gpo::test
