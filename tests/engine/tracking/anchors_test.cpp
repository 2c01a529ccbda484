// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "engine/tracking/tracker.h"
#include "tests/engine/desk.h"
#include "tests/engine/largest.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

constexpr int kFrames = 30;
constexpr int kLast = kFrames - 1;

Tracks tracked(Tracking tracking, const std::function<void(int frame, cv::Mat& bgr)>& change) {
  const auto recording = desk();
  const FrameCache images(kFrames, [recording, change](int i) {
    cv::Mat bgr = recording->images->bgr(i).clone();
    if (change) change(i, bgr);
    return bgr;
  });
  return *track_window(
      [&](int frame) { return images.gray(frame); }, recording->camera, {0, kFrames}, tracking);
}

const Tracks& undisturbed() {
  static const Tracks tracks = tracked(Tracking::anchored, {});
  return tracks;
}

/// Returns a track's distance from its place by the true poses and the true plane [px].
double error_px(const Tracks& tracks, int frame, int track) {
  const auto recording = desk();
  const Camera& camera = recording->camera;
  const Pose& first = *recording->truth->poses[0];
  const Eigen::Vector2d corner = undistort(camera, tracks.raw_px[0].col(track));
  const Eigen::Vector3d ray = intrinsic_matrix(camera).inverse() * corner.homogeneous();
  const auto point_w = intersect(*recording->plane, first, ray);
  if (!point_w) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d point_c = to_camera(*recording->truth->poses[frame], *point_w);
  return (project(camera, point_c) - tracks.raw_px[frame].col(track)).norm();
}

/// Returns the median over the living tracks, including the few off the plane with their parallax.
double median_error_px(const Tracks& tracks, int frame) {
  std::vector<double> errors;
  for (int j = 0; j < tracks.track_count(); ++j)
    if (tracks.seen(frame, j)) errors.push_back(error_px(tracks, frame, j));
  return median(std::move(errors));
}

int living(const Tracks& tracks, int frame) {
  return static_cast<int>(tracks.raw_px[frame].row(0).array().isFinite().count());
}

TEST(Anchors, RemoveDriftAndTolerateExposureAndBlur) {
  const Tracks drifting = tracked(Tracking::frame_to_frame, {});
  const Tracks& tracks = undisturbed();
  EXPECT_EQ(tracks.raw_px[0], drifting.raw_px[0]);
  EXPECT_GT(median_error_px(drifting, kLast), 0.5);
  for (int i = 1; i < kFrames; ++i) EXPECT_LT(median_error_px(tracks, i), 0.05) << i;
  EXPECT_GT(living(tracks, kLast), 0.95 * living(drifting, kLast));
  const Tracks blurred = tracked(Tracking::anchored, [](int i, cv::Mat& bgr) {
    bgr.convertTo(bgr, -1, 1 - 0.012 * i, 0.5 * i);
    if (i >= 10 && i < 15) cv::GaussianBlur(bgr, bgr, {}, 1.5);
  });
  EXPECT_LT(median_error_px(blurred, 12), 0.15);
  EXPECT_LT(median_error_px(blurred, kLast), 0.05);
  EXPECT_GT(living(blurred, kLast), 0.85 * living(undisturbed(), kLast));
}

TEST(Anchors, KeepTracksUnderAnExposureStepGammaAndVignetting) {
  for (const double gain : {0.7, 0.85, 1.2}) {
    const Tracks tracks = tracked(Tracking::anchored, [&](int i, cv::Mat& bgr) {
      if (i >= 10 && i < 20) bgr.convertTo(bgr, -1, gain);
    });
    EXPECT_LT(median_error_px(tracks, kLast), 0.05) << gain;
    EXPECT_GE(living(tracks, 10), 0.95 * living(undisturbed(), 10)) << gain;
    EXPECT_GE(living(tracks, kLast), 0.9 * living(undisturbed(), kLast)) << gain;
  }
  for (const double gamma : {1.0, 1.4}) {
    const Tracks tracks = tracked(Tracking::anchored, [&](int i, cv::Mat& bgr) {
      if (i < 10) return;
      bgr.forEach<cv::Vec3b>([&](cv::Vec3b& px, const int at[2]) {
        const double r2 = (std::pow(at[1] - 320, 2) + std::pow(at[0] - 240, 2)) / (320 * 320);
        for (std::uint8_t& value : px.val)
          value = cv::saturate_cast<std::uint8_t>(255 * 0.7 * (1 - 0.3 * r2) *
                                                  std::pow(value / 255.0, gamma));
      });
    });
    EXPECT_GE(living(tracks, kLast), 0.95 * living(undisturbed(), kLast)) << gamma;
    EXPECT_LT(median_error_px(tracks, kLast), 0.06) << gamma;
  }
}

TEST(Anchors, LoseHiddenTracksForGoodAndReportWhy) {
  const cv::Rect hidden(200, 140, 200, 180);
  const cv::Rect inner(hidden.x + 15, hidden.y + 15, hidden.width - 30, hidden.height - 30);
  const Tracks tracks = tracked(Tracking::anchored, [&](int i, cv::Mat& bgr) {
    if (i >= 10 && i < 20) bgr(hidden).setTo(cv::Scalar(40, 60, 90));
  });
  std::map<LossReason, int> ended;
  for (int j = 0; j < tracks.track_count(); ++j) {
    for (int i = 1; i < kFrames; ++i) EXPECT_LE(tracks.seen(i, j), tracks.seen(i - 1, j)) << i;
    const std::optional<TrackEnd>& end = tracks.ends[j];
    ASSERT_EQ(end.has_value(), !tracks.seen(kLast, j));
    if (tracks.seen(9, j)) {
      const Eigen::Vector2d before = tracks.raw_px[9].col(j);
      EXPECT_FALSE(tracks.seen(kLast, j) &&
                   inner.contains(cv::Point(int(before.x()), int(before.y()))))
          << j;
    }
    // The survivors did not move to the occluder.
    if (!end && undisturbed().seen(kLast, j)) {
      EXPECT_LT((tracks.raw_px[kLast].col(j) - undisturbed().raw_px[kLast].col(j)).norm(), 1) << j;
    }
    if (!end) continue;
    EXPECT_TRUE(tracks.seen(end->frame - 1, j) && !tracks.seen(end->frame, j));
    ++ended[end->reason];
    EXPECT_FALSE(end->reason == LossReason::far_from_prediction && end->value <= end->limit);
    EXPECT_FALSE(end->reason == LossReason::low_correlation && end->value >= end->limit);
  }
  EXPECT_LT(living(tracks, kLast), living(tracks, 9) - 20);
  EXPECT_LT(median_error_px(tracks, kLast), 0.05);
  EXPECT_GT(ended[LossReason::low_correlation] + ended[LossReason::far_from_prediction] +
                ended[LossReason::template_not_found],
            0);
}

TEST(Anchors, LoseTracksOutsideOfAStationaryImage) {
  const auto recording = desk();
  const cv::Mat smoothed = smooth_image(recording->images->gray(0));
  Camera camera = recording->camera;
  camera.distortion = Distortion::none;
  camera.coefficients = {};
  Eigen::Matrix2Xd corners(2, 44);
  for (int k = 0; k < 40; ++k) corners.col(k) << 60 + 60 * (k % 8), 60 + 70 * (k / 8);
  corners.rightCols<4>() << -40, 300, smoothed.cols + 9,
      std::numeric_limits<double>::quiet_NaN(),  //
      100, smoothed.rows + 60, 50, 20;
  Anchors anchors = make_anchors(smoothed, corners, camera);
  const FollowedTracks aligned =
      align_tracks(anchors, smoothed, corners, Eigen::Matrix2Xd::Zero(2, 44));
  int found = 0;
  for (int k = 0; k < 40; ++k) found += aligned.raw_px.col(k).allFinite() ? 1 : 0;
  EXPECT_GT(found, 20);
  for (int k = 40; k < 43; ++k) {
    EXPECT_FALSE(aligned.raw_px.col(k).allFinite()) << k;
    ASSERT_TRUE(aligned.ends[k]) << k;
    EXPECT_EQ(aligned.ends[k]->reason, LossReason::left_image) << k;
  }
  EXPECT_FALSE(aligned.raw_px.col(43).allFinite());
  EXPECT_FALSE(aligned.ends[43]);
}

TEST(Anchors, AreReproducible) {
  const Tracks again = tracked(Tracking::anchored, {});
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Array2Xd once_px = undisturbed().raw_px[i], again_px = again.raw_px[i];
    EXPECT_TRUE((once_px == again_px || (once_px.isNaN() && again_px.isNaN())).all()) << i;
  }
}

TEST(Anchors, FindLivingTracksFromARoughGuess) {
  const auto recording = desk();
  const cv::Mat gray = recording->images->gray(0);
  const Eigen::Matrix2Xd corners = detect_corners(gray);
  Eigen::Matrix2Xd before = corners;
  before.col(0).setConstant(std::nan(""));
  Eigen::Matrix2Xd flow = Eigen::Matrix2Xd::Zero(2, corners.cols());
  for (int j = 1; j < corners.cols(); ++j) flow.col(j) << (j % 2 == 0 ? 0.8 : -0.7), 0.5;
  Anchors anchors = make_anchors(smooth_image(gray), corners, recording->camera);
  const FollowedTracks aligned = align_tracks(anchors, smooth_image(gray), before, flow);
  EXPECT_FALSE(aligned.raw_px.col(0).allFinite());
  EXPECT_FALSE(aligned.ends[0]);
  int found = 0;
  for (int j = 1; j < corners.cols(); ++j) {
    if (!aligned.raw_px.col(j).allFinite()) continue;
    ++found;
    EXPECT_LT((aligned.raw_px.col(j) - corners.col(j)).norm(), 0.01) << j;
  }
  EXPECT_GT(found, 0.98 * static_cast<double>(corners.cols() - 1));
}

// The texture repeats, so a template also fits a period farther.
TEST(Anchors, FollowTheNeighborsInsteadOfJumping) {
  cv::Mat gray(240, 320, CV_8UC1);
  for (int v = 0; v < gray.rows; ++v)
    for (int u = 0; u < gray.cols; ++u)
      gray.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
          128 + 50 * std::sin(u * CV_PI / 8) + 50 * std::sin(v * CV_PI / 8));
  const Camera camera{320, 240, 300, 300, 160, 120, Distortion::none, {}};
  Eigen::Matrix2Xd corners(2, 30);
  for (int k = 0; k < 30; ++k) corners.col(k) << 40 + 48 * (k % 6), 40 + 40 * (k / 6);
  Eigen::Matrix2Xd flow = Eigen::Matrix2Xd::Zero(2, 30);
  flow.col(14) << 16, 0;
  const auto motion_px = [&](const AnchorOptions& options) -> Eigen::Matrix2Xd {
    const cv::Mat smoothed = smooth_image(gray);
    Anchors anchors = make_anchors(smoothed, corners, camera);
    return align_tracks(anchors, smoothed, corners, flow, options).raw_px - corners;
  };
  EXPECT_LT(largest(motion_px({})), 0.01);
  EXPECT_NEAR(motion_px({.least_alike = 30})(0, 14), 16, 0.1);
}

constexpr double kTexels = 480;  // per unit of length; about a pixel at distance 1
constexpr int kTexture = 2048;
constexpr int kSceneFrames = 20;

cv::Mat random_texture(std::uint64_t seed) {
  cv::RNG random(seed);
  cv::Mat noise(kTexture, kTexture, CV_32F);
  random.fill(noise, cv::RNG::NORMAL, 0, 1);
  cv::Mat fine, coarse;
  cv::GaussianBlur(noise, fine, {}, 2);
  cv::GaussianBlur(noise, coarse, {}, 7);
  const cv::Mat sum = 240 * fine + 700 * coarse + 128;
  return cv::max(cv::min(sum, 245), 10);
}

Pose scene_pose(int frame) {
  const double t = frame / (kSceneFrames - 1.0);
  const Eigen::AngleAxisd rotation(0.12 * t, Eigen::Vector3d(0.3, -1, 0.4).normalized());
  return {rotation.toRotationMatrix(), {0.28 * t, -0.05 * std::sin(3 * t), 0.1 * t}};
}

/// A plane, normal . X = distance.
struct Surface {
  Eigen::Vector3d normal;
  double distance;
  Eigen::Vector3d along, across;
  cv::Mat texture;
};

std::pair<int, double> hit(const std::array<Surface, 2>& surfaces,
                           const Eigen::Vector3d& from,
                           const Eigen::Vector3d& ray) {
  std::pair<int, double> nearest{0, 1e9};
  for (int k = 0; k < 2; ++k) {
    const double depth =
        (surfaces[k].distance - surfaces[k].normal.dot(from)) / surfaces[k].normal.dot(ray);
    if (depth > 0 && depth < nearest.second) nearest = {k, depth};
  }
  return nearest;
}

/// A textured floor and wall that meet in front of a camera, which moves sideways and rotates.
/// World: the reference camera.
class CornerScene {
 public:
  CornerScene() {
    const Eigen::Vector3d floor = Eigen::Vector3d(0.1, 1, 0.25).normalized();
    const Eigen::Vector3d wall = Eigen::Vector3d(-0.2, -0.1, 1).normalized();
    const auto surface = [](const Eigen::Vector3d& normal, double distance, std::uint64_t seed) {
      const Eigen::Vector3d along = normal.unitOrthogonal();
      return Surface{normal, distance, along, normal.cross(along), random_texture(seed)};
    };
    surfaces_ = {surface(floor, 0.38, 1), surface(wall, 1.4, 2)};
    for (int v = 0; v < camera.height; ++v)
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector3d ray = ray_at(Eigen::Vector2d(u, v));
        rays_.at<cv::Vec2d>(v, u) = {ray.x(), ray.y()};
      }
  }

  /// Returns an image with noise, CV_8UC1.
  cv::Mat gray(int frame) const {
    const Pose pose = scene_pose(frame);
    std::array<cv::Mat, 2> maps;
    for (cv::Mat& map : maps) map = cv::Mat(rays_.size(), CV_32FC2, cv::Scalar(-1, -1));
    for (int v = 0; v < rays_.rows; ++v)
      for (int u = 0; u < rays_.cols; ++u) {
        const auto& r = rays_.at<cv::Vec2d>(v, u);
        const Eigen::Vector3d ray = pose.R_wc * Eigen::Vector3d(r[0], r[1], 1);
        const auto [k, depth] = hit(surfaces_, pose.p_wc, ray);
        const Eigen::Vector3d point = pose.p_wc + depth * ray;
        maps[k].at<cv::Vec2f>(v, u) = cv::Vec2f(
            static_cast<float>(kTexture / 2.0 + kTexels * surfaces_[k].along.dot(point)),
            static_cast<float>(kTexture / 2.0 + kTexels * surfaces_[k].across.dot(point)));
      }
    cv::Mat sum = cv::Mat::zeros(rays_.size(), CV_32F);
    for (int k = 0; k < 2; ++k) {
      cv::Mat part;
      cv::remap(surfaces_[k].texture, part, maps[k], {}, cv::INTER_CUBIC, cv::BORDER_CONSTANT);
      sum += part;
    }
    cv::RNG random(1000 + frame);
    cv::Mat noise(sum.size(), CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0, 1);
    cv::Mat gray;
    cv::Mat(sum + noise).convertTo(gray, CV_8U);
    return gray;
  }

  /// Returns the plane at a raw pixel of the reference image: 0 the floor, 1 the wall.
  int plane_at(const Eigen::Vector2d& raw_px) const {
    return hit(surfaces_, Eigen::Vector3d::Zero(), ray_at(raw_px)).first;
  }
  /// Returns where a raw pixel of the reference image is in another frame.
  Eigen::Vector2d moved(const Eigen::Vector2d& raw_px, int frame) const {
    const Eigen::Vector3d ray = ray_at(raw_px);
    const double depth = hit(surfaces_, Eigen::Vector3d::Zero(), ray).second;
    return project(camera, to_camera(scene_pose(frame), depth * ray));
  }

  const Camera camera{
      480, 360, 400, 398, 242, 178, Distortion::radial_tangential, {0.08, -0.12, 5e-4, -8e-4}};

 private:
  Eigen::Vector3d ray_at(const Eigen::Vector2d& raw_px) const {
    return intrinsic_matrix(camera).inverse() * undistort(camera, raw_px).homogeneous();
  }

  std::array<Surface, 2> surfaces_;
  /// x and y of every pixel at depth 1.
  cv::Mat rays_ = cv::Mat(camera.height, camera.width, CV_64FC2);
};

TEST(Anchors, AreAccurateOnEverySurface) {
  const CornerScene scene;
  const Tracks tracks = *track_window([&](int frame) { return scene.gray(frame); },
                                      scene.camera,
                                      {0, kSceneFrames},
                                      Tracking::anchored);
  const int last = kSceneFrames - 1;
  for (const int plane : {0, 1}) {
    std::vector<double> errors;
    for (int j = 0; j < tracks.track_count(); ++j) {
      const Eigen::Vector2d corner = tracks.raw_px[0].col(j);
      // Templates that show both surfaces are ignored.
      const bool whole = scene.plane_at(corner + Eigen::Vector2d(0, 14)) == plane &&
                         scene.plane_at(corner - Eigen::Vector2d(0, 14)) == plane;
      if (whole && tracks.seen(last, j))
        errors.push_back((scene.moved(corner, last) - tracks.raw_px[last].col(j)).norm());
    }
    ASSERT_GT(errors.size(), 40U) << plane;
    std::ranges::sort(errors);
    EXPECT_LT(quantile(errors, 0.9), 0.1) << plane;
    EXPECT_LT(median(std::move(errors)), 0.03) << plane;
  }
}

TEST(Anchors, WorkWithoutNeighbors) {
  const auto recording = desk();
  const cv::Mat smoothed = smooth_image(recording->images->gray(0));
  const Eigen::Matrix2Xd corners = detect_corners(recording->images->gray(0)).leftCols(3);
  Anchors anchors = make_anchors(smoothed, corners, recording->camera);
  const FollowedTracks aligned =
      align_tracks(anchors, smoothed, corners, Eigen::Matrix2Xd::Zero(2, 3));
  EXPECT_LT(largest(aligned.raw_px - corners), 0.01);
  const Eigen::Matrix2Xd none(2, 0);
  Anchors empty = make_anchors(smoothed, none, recording->camera);
  EXPECT_EQ(align_tracks(empty, smoothed, none, none).raw_px.cols(), 0);
}

}  // namespace
}  // namespace gpo::test
