// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/image_zoom.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;

const Camera kZoomedCamera{640, 480, 500, 510, 322, 236, Distortion::none, {}};
const ScreenRect kZoomedRect{{100, 50}, {1280, 480}};

TEST(ImageZoom, ImageFitsAndIsCentered) {
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, {});
  EXPECT_DOUBLE_EQ(mapping.scale, 1);
  EXPECT_EQ(mapping.origin, Vector2d(100 + 320, 50));
}

TEST(ImageZoom, CentersOfPixelsAreHalfAPixelIn) {
  const ImageMapping mapping{{10, 20}, 4};
  EXPECT_EQ(to_screen(mapping, {0, 0}), Vector2d(12, 22));
  EXPECT_EQ(to_screen(mapping, {-0.5, -0.5}), Vector2d(10, 20));
  EXPECT_LT((to_image(mapping, to_screen(mapping, {3.25, 7.5})) - Vector2d(3.25, 7.5)).norm(),
            1e-12);
}

TEST(ImageZoom, ZoomKeepsWhatIsUnderThePointer) {
  ImageZoom zoom;
  const Vector2d pointer(700, 300);
  const Vector2d before = to_image(map_image(kZoomedCamera, kZoomedRect, zoom), pointer);
  for (int i = 0; i < 5; ++i) zoom = zoom_about(zoom, kZoomedCamera, kZoomedRect, pointer, 1.3);
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, zoom);
  // The picture's corner is on a whole pixel of the screen.
  EXPECT_LT((to_image(mapping, pointer) - before).norm(), 1 / mapping.scale);
  EXPECT_NEAR(zoom.factor, std::pow(1.3, 5), 1e-9);
  EXPECT_EQ(zoom_about(zoom, kZoomedCamera, kZoomedRect, pointer, 1e-9).factor, 1);
}

TEST(ImageZoom, PanFollowsThePointer) {
  ImageZoom zoom{4, {0.5, 0.5}};
  const Vector2d before = to_screen(map_image(kZoomedCamera, kZoomedRect, zoom), {320, 240});
  zoom = pan(zoom, kZoomedCamera, kZoomedRect, {30, -12});
  const Vector2d after = to_screen(map_image(kZoomedCamera, kZoomedRect, zoom), {320, 240});
  EXPECT_EQ(after - before, Vector2d(30, -12));
}

TEST(ImageMapping, WithoutDistortionIsWhatOpenCvsUndistortedPointsAreShownAt) {
  Camera camera = kZoomedCamera;
  camera.fx = camera.fy = 400;
  camera.cx = 330;
  camera.cy = 250;
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = {-0.28, 0.07, 0.0005, -0.0008};
  const ImageMapping mapping{{10, 20}, 2, &camera};
  const cv::Mat K = (cv::Mat_<double>(3, 3) << 400, 0, 330, 0, 400, 250, 0, 0, 1);
  for (const Vector2d& raw_px : {Vector2d(12, 30), Vector2d(330, 250), Vector2d(600, 460)}) {
    std::vector<cv::Point2d> pinhole_px;
    cv::undistortPoints(
        std::vector{cv::Point2d(raw_px.x(), raw_px.y())},
        pinhole_px,
        K,
        camera.coefficients,
        {},
        K,
        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12));
    const Vector2d on_screen(10 + 2 * (pinhole_px[0].x + 0.5), 20 + 2 * (pinhole_px[0].y + 0.5));
    EXPECT_LT((to_screen(mapping, raw_px) - on_screen).norm(), 1e-6);
    EXPECT_LT((to_image(mapping, on_screen) - raw_px).norm(), 1e-6);
  }
}

}  // namespace
}  // namespace gpo
