// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/frontend/anchors.h"

#include "engine/frontend/tracker.h"
#include "engine/frontend/tracking.h"
#include "engine/geometry/statistics.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/window/tracks.h"

#include <functional>
#include <limits>
#include <map>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kFrames = 30;
constexpr int kLast = kFrames - 1;

std::shared_ptr<const Recording> desk() { return open_recording(GPO_SOURCE_DIR "/sequences/desk"); }

Tracks tracked(const Recording& recording, const FrameCache& pictures, Tracking tracking) {
  TrackerOptions options;
  options.tracking = tracking;
  return *track_window(
      [&](int frame) { return pictures.gray(frame); }, recording.camera, 0, kFrames, options);
}

/// The recording's pictures, each changed in place.
FrameCache changed(const std::shared_ptr<const Recording>& recording,
                   const std::function<void(int frame, cv::Mat& bgr)>& change) {
  return FrameCache(kFrames, [recording, change](int i) {
    cv::Mat bgr = recording->pictures->bgr(i).clone();
    change(i, bgr);
    return bgr;
  });
}

/// Distance of a track from where the true poses and the true plane take its corner [px].
double error_px(const Recording& recording, const Tracks& tracks, int frame, int track) {
  const Pose& first = *recording.truth->poses[0];
  const Pose& now = *recording.truth->poses[frame];
  const Eigen::Vector2d corner = undistort(recording.camera, tracks.raw_px[0].col(track));
  const Eigen::Vector3d ray =
      first.R_wc * intrinsic_matrix(recording.camera).inverse() * corner.homogeneous();
  const Plane& plane = *recording.plane;
  const double depth = -(plane.normal.dot(first.p_wc) + plane.distance) / plane.normal.dot(ray);
  const Eigen::Vector3d point_c = to_camera(now, first.p_wc + depth * ray);
  return (project(recording.camera, point_c) - tracks.raw_px[frame].col(track)).norm();
}

/// Of the living tracks, also the few off the plane, whose error is their parallax.
double median_error_px(const Recording& recording, const Tracks& tracks, int frame) {
  std::vector<double> errors;
  for (int j = 0; j < tracks.track_count(); ++j) {
    if (tracks.seen(frame, j)) errors.push_back(error_px(recording, tracks, frame, j));
  }
  return median(std::move(errors));
}

int living(const Tracks& tracks, int frame) {
  int count = 0;
  for (int j = 0; j < tracks.track_count(); ++j) count += tracks.seen(frame, j) ? 1 : 0;
  return count;
}

TEST(Anchors, TakeTheDriftFromTracksOnThePlane) {
  const auto recording = desk();
  const Tracks drifting = tracked(*recording, *recording->pictures, Tracking::frame_to_frame);
  const Tracks held = tracked(*recording, *recording->pictures, Tracking::anchored);
  EXPECT_EQ(held.raw_px[0], drifting.raw_px[0]);
  EXPECT_GT(median_error_px(*recording, drifting, kLast), 0.5);
  for (int i = 1; i < kFrames; ++i) EXPECT_LT(median_error_px(*recording, held, i), 0.05) << i;
  EXPECT_GT(living(held, kLast), 0.95 * living(drifting, kLast));
}

TEST(Anchors, SurviveExposureAndBlur) {
  const auto recording = desk();
  const FrameCache pictures = changed(recording, [](int i, cv::Mat& bgr) {
    bgr.convertTo(bgr, -1, 1 - 0.012 * i, 0.5 * i);
    if (i >= 10 && i < 15) cv::GaussianBlur(bgr, bgr, {}, 1.5);
  });
  const Tracks held = tracked(*recording, pictures, Tracking::anchored);
  EXPECT_LT(median_error_px(*recording, held, 12), 0.12);
  EXPECT_LT(median_error_px(*recording, held, kLast), 0.12);
  const Tracks undisturbed = tracked(*recording, *recording->pictures, Tracking::anchored);
  EXPECT_GT(living(held, kLast), 0.85 * living(undisturbed, kLast));
}

TEST(Anchors, SurviveAJumpOfTheExposure) {
  const auto recording = desk();
  const Tracks undisturbed = tracked(*recording, *recording->pictures, Tracking::anchored);
  for (const double gain : {0.7, 0.85, 1.2}) {
    const FrameCache pictures = changed(recording, [&](int i, cv::Mat& bgr) {
      if (i >= 10 && i < 20) bgr.convertTo(bgr, -1, gain);
    });
    const Tracks held = tracked(*recording, pictures, Tracking::anchored);
    EXPECT_LT(median_error_px(*recording, held, kLast), 0.05) << gain;
    EXPECT_GE(living(held, 10), 0.95 * living(undisturbed, 10)) << gain;
    EXPECT_GE(living(held, kLast), 0.9 * living(undisturbed, kLast)) << gain;
  }
}

TEST(Anchors, LoseWhatIsHiddenForGoodAndKeepTheRest) {
  const auto recording = desk();
  const cv::Rect hidden(200, 140, 200, 180);
  const FrameCache pictures = changed(recording, [&](int i, cv::Mat& bgr) {
    if (i >= 10 && i < 20) bgr(hidden).setTo(cv::Scalar(40, 60, 90));
  });
  const Tracks held = tracked(*recording, pictures, Tracking::anchored);
  for (int j = 0; j < held.track_count(); ++j) {
    for (int i = 1; i < kFrames; ++i) EXPECT_LE(held.seen(i, j), held.seen(i - 1, j)) << i;
    const cv::Rect inner(hidden.x + 15, hidden.y + 15, hidden.width - 30, hidden.height - 30);
    if (!held.seen(9, j)) continue;
    const Eigen::Vector2d before = held.raw_px[9].col(j);
    if (inner.contains(cv::Point(int(before.x()), int(before.y())))) {
      EXPECT_FALSE(held.seen(kLast, j)) << j;
    }
  }
  EXPECT_LT(living(held, kLast), living(held, 9) - 20);
  EXPECT_LT(median_error_px(*recording, held, kLast), 0.05);
  // Nothing that lives took hold of what hid it: where it is, it also is without.
  const Tracks undisturbed = tracked(*recording, *recording->pictures, Tracking::anchored);
  for (int j = 0; j < held.track_count(); ++j) {
    if (!held.seen(kLast, j) || !undisturbed.seen(kLast, j)) continue;
    EXPECT_LT((held.raw_px[kLast].col(j) - undisturbed.raw_px[kLast].col(j)).norm(), 0.5) << j;
  }
}

// The quadratics between nine exact places against every pixel's own, with the recordings' lens and
// a camera that went 15 degrees around the middle of the picture.
TEST(Anchors, CarryPatchesToAFewThousandthsOfAPixel) {
  const Camera camera = desk()->camera;
  const Eigen::Matrix3d K = intrinsic_matrix(camera);
  const Eigen::Matrix3d R(Eigen::AngleAxisd(0.26, Eigen::Vector3d(0.2, 0.9, 0.3).normalized()));
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();  // the middle; the plane is Z = 1
  const Eigen::Vector3d center = z - R.transpose() * z;
  const Eigen::Matrix3d H =
      K * R * (Eigen::Matrix3d::Identity() - center * z.transpose()) * K.inverse();
  constexpr int kHalf = 10;
  constexpr int kSide = 2 * kHalf + 1;
  int patches = 0;
  for (int corner = 0; corner < 32 * 24; ++corner) {
    const cv::Point first(20 * (corner % 32), 20 * (corner / 32));
    const auto exact = [&](int u, int v) {
      const Eigen::Vector2d px(first.x + u, first.y + v);
      return distort(camera, (H * undistort(camera, px).homogeneous()).hnormalized());
    };
    Nodes nodes;
    for (int k = 0; k < 9; ++k) nodes.col(k) = exact(kHalf * (k % 3), kHalf * (k / 3));
    const Eigen::Vector2d middle = nodes.col(4);
    if (middle.minCoeff() < 0 || middle.x() > camera.width || middle.y() > camera.height) continue;
    ++patches;
    const Eigen::Matrix2Xf places = places_between(nodes, kSide, kSide);
    double worst_px = 0;
    for (int k = 0; k < kSide * kSide; ++k) {
      const Eigen::Vector2d error = places.col(k).cast<double>() - exact(k % kSide, k / kSide);
      worst_px = std::max(worst_px, error.norm());
    }
    EXPECT_LT(worst_px, 0.005) << middle.transpose();
  }
  EXPECT_GT(patches, 400);
}

// A plane at rest, so that all agree with its homography, those outside of the picture, too.
TEST(Anchors, WhatIsNotInThePictureIsNotFoundThere) {
  const auto recording = desk();
  const cv::Mat gray = recording->pictures->gray(0);
  Camera camera = recording->camera;
  camera.distortion = Distortion::none;
  camera.coefficients = {};
  Eigen::Matrix2Xd corners(2, 44);
  for (int k = 0; k < 40; ++k) corners.col(k) << 60 + 60 * (k % 8), 60 + 70 * (k / 8);
  corners.rightCols<4>() << -40, 300, gray.cols + 9, std::numeric_limits<double>::quiet_NaN(),  //
      100, gray.rows + 60, 50, 20;
  const Anchors anchors = make_anchors(gray, corners, camera);
  const Held held = hold(anchors, gray, corners);
  int found = 0;
  for (int k = 0; k < 40; ++k) found += held.raw_px.col(k).allFinite() ? 1 : 0;
  EXPECT_GT(found, 20);
  for (int k = 40; k < 43; ++k) {
    EXPECT_FALSE(held.raw_px.col(k).allFinite()) << k;
    ASSERT_TRUE(held.ends[k]) << k;
    EXPECT_EQ(held.ends[k]->reason, LossReason::look_not_found) << k;
  }
}

TEST(Anchors, AreTheSameInEveryRun) {
  const auto recording = desk();
  const Tracks once = tracked(*recording, *recording->pictures, Tracking::anchored);
  const Tracks again = tracked(*recording, *recording->pictures, Tracking::anchored);
  for (int i = 0; i < kFrames; ++i) {
    for (int j = 0; j < once.track_count(); ++j) {
      ASSERT_EQ(once.seen(i, j), again.seen(i, j));
      if (!once.seen(i, j)) continue;
      ASSERT_EQ(once.raw_px[i].col(j), again.raw_px[i].col(j));
    }
  }
}

TEST(Anchors, LeaveTheLostLostAndTracksOffThePlaneWhereTheyWere) {
  const auto recording = desk();
  const cv::Mat gray = recording->pictures->gray(0);
  const Eigen::Matrix2Xd corners = detect_corners(gray);
  Eigen::Matrix2Xd followed = corners;
  followed.col(0).setConstant(std::nan(""));
  for (int j = 1; j < followed.cols(); ++j) followed(0, j) += j % 5 == 0 ? 10 : 0.3;
  const Eigen::Matrix2Xd held =
      hold(make_anchors(gray, corners, recording->camera), gray, followed).raw_px;
  EXPECT_FALSE(held.col(0).allFinite());
  for (int j = 1; j < held.cols(); ++j) {
    const Eigen::Matrix2Xd& expected = j % 5 == 0 ? followed : corners;
    EXPECT_LT((held.col(j) - expected.col(j)).norm(), 1e-3) << j;
  }
}

TEST(Anchors, TellWhyALookIsNotFound) {
  const auto recording = desk();
  const cv::Rect hidden(200, 140, 200, 180);
  const FrameCache pictures = changed(recording, [&](int i, cv::Mat& bgr) {
    if (i >= 10) bgr(hidden).setTo(cv::Scalar(40, 60, 90));
  });
  const Tracks held = tracked(*recording, pictures, Tracking::anchored);
  std::map<LossReason, int> ended;
  for (int j = 0; j < held.track_count(); ++j) {
    const std::optional<TrackEnd>& end = held.ends[j];
    ASSERT_EQ(end.has_value(), !held.seen(kLast, j));
    if (!end) continue;
    EXPECT_TRUE(held.seen(end->frame - 1, j) && !held.seen(end->frame, j));
    ++ended[end->reason];
    if (end->reason == LossReason::look_far) {
      EXPECT_GT(end->value, end->limit);
    }
    if (end->reason == LossReason::look_unlike) {
      EXPECT_LT(end->value, end->limit);
    }
  }
  EXPECT_GT(ended[LossReason::look_unlike] + ended[LossReason::look_far] +
                ended[LossReason::look_not_found],
            0);
}

TEST(Anchors, LeaveAllAsItIsWhereThereIsNoPlane) {
  const auto recording = desk();
  const cv::Mat gray = recording->pictures->gray(0);
  const Eigen::Matrix2Xd corners = detect_corners(gray).leftCols(3);
  const Anchors anchors = make_anchors(gray, corners, recording->camera);
  EXPECT_EQ(hold(anchors, gray, corners).raw_px, corners);
  EXPECT_EQ(hold(make_anchors(gray, Eigen::Matrix2Xd(2, 0), recording->camera),
                 gray,
                 Eigen::Matrix2Xd(2, 0))
                .raw_px.cols(),
            0);
}

}  // namespace
}  // namespace gpo
