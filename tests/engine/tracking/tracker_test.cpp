// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/tracking/tracker.h"

#include "engine/geometry/homography.h"
#include "engine/planes/inliers.h"

#include <cmath>
#include <map>

#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix2Xd, Eigen::Matrix3d, Eigen::Vector2d;

constexpr int kWidth = 320;
constexpr int kHeight = 240;
const Camera kSmallCamera{kWidth, kHeight, 300, 300, 160, 120, Distortion::none, {}};

/// Returns an image in closed form, so that a shift is exact: smooth blobs on a jittered grid.
cv::Mat blobs(double shift_x, double shift_y) {
  cv::Mat image(kHeight, kWidth, CV_64F, cv::Scalar(90));
  for (int row = -1; row <= 12; ++row)
    for (int column = -1; column <= 16; ++column) {
      const double x = 20 * column + 5 * std::sin(7.0 * row + 3 * column) + shift_x;
      const double y = 20 * row + 5 * std::cos(5.0 * column + 2 * row) + shift_y;
      const double height = (row + column) % 2 == 0 ? 110 : -70;
      for (int v = std::max(0, int(y) - 10); v < std::min(kHeight, int(y) + 11); ++v)
        for (int u = std::max(0, int(x) - 10); u < std::min(kWidth, int(x) + 11); ++u) {
          const double r2 = (u - x) * (u - x) + (v - y) * (v - y);
          image.at<double>(v, u) += height * std::exp(-r2 / (2 * 2.5 * 2.5));
        }
    }
  cv::Mat gray;
  image.convertTo(gray, CV_8U);
  return gray;
}

const GrayImages moving_image = [](int frame) { return blobs(1.3 * frame, -0.7 * frame); };

TEST(Detector, SpreadsCornersOverTheImageUnlessItIsUniform) {
  const Matrix2Xd corners = detect_corners(blobs(0, 0));
  EXPECT_GT(corners.cols(), 60);
  std::array<int, 4> quadrants{};
  for (const auto& c : corners.colwise())
    ++quadrants[(c.x() > 160 ? 1 : 0) + (c.y() > 120 ? 2 : 0)];
  for (const int count : quadrants) EXPECT_GT(count, corners.cols() / 8);
  for (int j = 0; j < corners.cols(); ++j)
    for (int k = 0; k < j; ++k) EXPECT_GT((corners.col(j) - corners.col(k)).norm(), 1.0);
  EXPECT_EQ(detect_corners(cv::Mat(kHeight, kWidth, CV_8U, cv::Scalar(128))).cols(), 0);
}

const Tracks& moving_tracks() {
  static const Tracks tracks = *track_window(moving_image, kSmallCamera, {0, 30});
  return tracks;
}

TEST(Tracker, FollowsAnExactShiftToAFewHundredthsOfAPixel) {
  const Tracks& tracks = moving_tracks();
  EXPECT_EQ(tracks.frame_count(), 30);
  double squares = 0;
  int alive = 0;
  for (int j = 0; j < tracks.track_count(); ++j) {
    if (!tracks.seen(9, j)) continue;
    const Vector2d moved = tracks.raw_px[9].col(j) - tracks.raw_px[0].col(j);
    squares += (moved - Vector2d(1.3 * 9, -0.7 * 9)).squaredNorm();
    ++alive;
  }
  EXPECT_GT(alive, tracks.track_count() / 2);
  EXPECT_LT(std::sqrt(squares / alive), 0.1);
}

TEST(Tracker, EndsTracksForGoodAndReportsWhy) {
  const Tracks& tracks = moving_tracks();
  ASSERT_EQ(static_cast<int>(tracks.ends.size()), tracks.track_count());
  ASSERT_EQ(tracks.forward_backward_px.size(), 30U);
  EXPECT_TRUE(tracks.forward_backward_px[0].array().isNaN().all());
  std::map<LossReason, int> ended;
  for (int j = 0; j < tracks.track_count(); ++j) {
    const std::optional<TrackEnd>& end = tracks.ends[j];
    for (int i = 0; i < 30; ++i) {
      ASSERT_EQ(tracks.seen(i, j), !end || i < end->frame);
      if (!tracks.seen(i, j)) continue;
      EXPECT_GE(tracks.raw_px[i](0, j), 0);
      EXPECT_LE(tracks.raw_px[i](0, j), kWidth - 1);
      if (i > 0) {
        EXPECT_LE(tracks.forward_backward_px[i][j], 0.5);
      }
    }
    if (!end) continue;
    ++ended[end->reason];
    if (end->reason == LossReason::forward_backward) {
      EXPECT_EQ(end->limit, 0.5);
      EXPECT_GT(end->value, 0.5);
      EXPECT_EQ(end->value, tracks.forward_backward_px[end->frame][j]);
    } else {
      EXPECT_TRUE(std::isnan(end->value));
    }
  }
  EXPECT_GT(ended[LossReason::left_image], 10);  // the texture moves by 38 px to the right
}

TEST(Tracker, StopsOnRequestAndReportsProgress) {
  std::stop_source source;
  source.request_stop();
  EXPECT_FALSE(track_window(
      moving_image, kSmallCamera, {0, 3}, Tracking::frame_to_frame, {source.get_token()}));
  std::vector<int> reported;
  const auto progress = [&](int done, int of) {
    EXPECT_EQ(of, 3);
    reported.push_back(done);
  };
  track_window(
      moving_image, kSmallCamera, {0, 3}, Tracking::frame_to_frame, {.progress = progress});
  EXPECT_EQ(reported, (std::vector<int>{1, 2, 3}));
}

TEST(SelectTracks, SelectsTracksOfTheReferenceFrameAndKeepsGaps) {
  const std::vector<TrackObservation> observations{{0, 7, {1, 1}},
                                                   {1, 7, {2, 2}},
                                                   {1, 8, {5, 5}},
                                                   {2, 8, {6, 6}},
                                                   {3, 7, {4, 4}},
                                                   {3, 8, {7, 7}}};
  const Tracks tracks = select_tracks(observations, 1, 3);
  ASSERT_EQ(tracks.ids, (std::vector<std::int64_t>{7, 8}));
  EXPECT_EQ(tracks.raw_px[0].col(0), Vector2d(2, 2));
  EXPECT_FALSE(tracks.seen(1, 0));
  EXPECT_EQ(tracks.raw_px[2].col(0), Vector2d(4, 4));
  EXPECT_EQ(tracks.raw_px[2].col(1), Vector2d(7, 7));
  EXPECT_TRUE(tracks.forward_backward_px.empty() && tracks.ends.empty());
}

TEST(MakeWindow, UndistortsAndMarksInliers) {
  const auto tracks = track_window(moving_image, kSmallCamera, {0, 6});
  const Camera camera{
      kWidth, kHeight, 300, 300, 160, 120, Distortion::radial_tangential, {0.1, 0, 0, 0}};
  const std::vector<std::int64_t> times{0, 1, 2, 3, 4, 5};
  const Window window = make_window(*tracks, camera, times, {});
  for (int j = 0; j < window.track_count(); ++j) {
    EXPECT_LT((window.points_px[0].col(j) - undistort(camera, tracks->raw_px[0].col(j))).norm(),
              1e-12);
    for (int i = 1; i < 6; ++i) EXPECT_LE(window.inlier[i][j], tracks->seen(i, j));
  }
  EXPECT_GT(window.inlier_count(0), window.track_count() / 2);
  const Window all = make_window(*tracks, camera, times, {.ransac = {.enabled = false}});
  for (int j = 0; j < all.track_count(); ++j) EXPECT_EQ(all.inlier[5][j], tracks->seen(5, j));
}

TEST(Without, HidesTracksAndKeepsColumns) {
  const Tracks tracks{0, {3, 5, 8}, {Matrix2Xd::Ones(2, 3), Matrix2Xd::Ones(2, 3)}};
  const Tracks left = without(tracks, std::vector<std::int64_t>{5});
  EXPECT_EQ(left.ids, tracks.ids);
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(left.seen(i, 1));
    EXPECT_EQ(left.raw_px[i].col(2), tracks.raw_px[i].col(2));
  }
}

constexpr int kHalf = kHalfPatch_px;
constexpr auto kRadial = Distortion::radial_tangential;
const Camera kCamera{640, 480, 498.2, 497.6, 322.4, 238.1, kRadial, {0.092, -0.184, 6e-4, -9e-4}};

/// Returns the homography of a camera that moved by 15 degrees, or a part of them, around the
/// middle of the image; the plane is Z = `distance`.
Matrix3d homography(double distance, double part = 1) {
  const Matrix3d K = intrinsic_matrix(kCamera);
  const Matrix3d R(Eigen::AngleAxisd(0.26 * part, Eigen::Vector3d(0.2, 0.9, 0.3).normalized()));
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d center = z - R.transpose() * z;
  return K * R * (Matrix3d::Identity() - center * z.transpose() / distance) * K.inverse();
}

Vector2d carried(const Matrix3d& H, const Vector2d& raw_px) {
  return distort(kCamera, transfer(H, undistort(kCamera, raw_px)));
}

Warp affine_warp(const Matrix3d& H, const Vector2d& middle) {
  const double h = 4;
  Warp warp{carried(H, middle)};
  const auto slope = [&](const Vector2d& d) -> Vector2d {
    return (carried(H, middle + d) - carried(H, middle - d)) / (2 * h);
  };
  warp.linear << slope({h, 0}), slope({0, h});
  return warp;
}

double worst_px(const Warp& warp, const Matrix3d& H, const Vector2d& middle) {
  double worst = 0;
  for (int v = -kHalf; v <= kHalf; ++v)
    for (int u = -kHalf; u <= kHalf; ++u)
      worst = std::max(worst, (warp({u, v}) - carried(H, middle + Vector2d(u, v))).norm());
  return worst;
}

bool in_image(const Vector2d& raw_px) {
  return raw_px.minCoeff() > kHalf && raw_px.x() < kCamera.width - kHalf &&
         raw_px.y() < kCamera.height - kHalf;
}

Matrix2Xd grid() {
  Matrix2Xd places(2, 15 * 11);
  for (int k = 0; k < places.cols(); ++k) places.col(k) << 40 + 40 * (k % 15), 40 + 40 * (k / 15);
  return places;
}

TEST(LocalShape, MatchesHomographyAndLensOfAPlane) {
  const Matrix2Xd places = grid();
  const Matrix3d H = homography(1);
  Matrix2Xd now(2, places.cols());
  for (int j = 0; j < places.cols(); ++j)
    now.col(j) = undistort(kCamera, carried(H, places.col(j)));
  auto around = make_neighborhoods(kCamera, places);
  int better = 0;
  for (int j = 0; j < places.cols(); ++j) {
    const Vector2d middle = places.col(j);
    const Warp affine = affine_warp(H, middle);
    if (!now.col(j).allFinite() || !in_image(affine.center)) continue;
    const Warp shape = shaped(kCamera, affine, now, around[j]);
    EXPECT_EQ(shape.center, affine.center);
    EXPECT_LT(worst_px(shape, H, middle), 0.02) << middle.transpose();
    better += worst_px(affine, H, middle) > 0.03 ? 1 : 0;
  }
  EXPECT_GT(better, 60);
}

// Every third track is on a plane that is nearer by a third, and some tracks are lost.
TEST(LocalShape, IgnoresNeighborsOnAnotherSurface) {
  constexpr int kFrames = 10;
  const Matrix2Xd places = grid();
  auto around = make_neighborhoods(kCamera, places);
  for (int frame = 1; frame <= kFrames; ++frame) {
    const double part = static_cast<double>(frame) / kFrames;
    const Matrix3d H[] = {homography(1, part), homography(0.7, part)};
    Matrix2Xd now(2, places.cols());
    for (int j = 0; j < places.cols(); ++j)
      now.col(j) = undistort(kCamera, carried(H[j % 3 == 0 ? 1 : 0], places.col(j)));
    for (int j = 0; j < places.cols(); j += 10) now.col(j).setConstant(std::nan(""));
    for (int j = 0; j < places.cols(); ++j) {
      const Matrix3d& own = H[j % 3 == 0 ? 1 : 0];
      const Vector2d middle = places.col(j);
      const Warp affine = affine_warp(own, middle);
      if (!now.col(j).allFinite() || !in_image(affine.center)) continue;
      const Warp shape = shaped(kCamera, affine, now, around[j]);
      EXPECT_LT(worst_px(shape, own, middle), 0.05 + 0.5 * worst_px(affine, own, middle))
          << frame << ": " << j;
    }
  }
}

TEST(LocalShape, IsTheTemplatesOwnWithoutNeighbors) {
  Matrix2Xd alone(2, 1);
  alone << 200, 150;
  const Warp warp = affine_warp(homography(1), alone.col(0));
  auto around = make_neighborhoods(kCamera, alone);
  EXPECT_TRUE(around[0].neighbors.empty());
  const Warp shape = shaped(kCamera, warp, alone, around[0]);
  for (const Vector2d& d : {Vector2d(-10, 10), Vector2d(10, 10), Vector2d(0, -10)})
    EXPECT_LT((shape(d) - warp(d)).norm(), 0.01);
}

}  // namespace
}  // namespace gpo
