// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/zoom.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;

const Camera kZoomedCamera{640, 480, 500, 510, 322, 236, Distortion::none, {}};
const ScreenRect kZoomedRect{{100, 50}, {1280, 480}};

TEST(ImageZoom, FitsAndCentersTheImage) {
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, {});
  EXPECT_DOUBLE_EQ(mapping.scale, 1);
  EXPECT_EQ(mapping.origin, Vector2d(100 + 320, 50));
}

TEST(ImageZoom, PutsPixelCentersHalfAPixelFromTheCorner) {
  const ImageMapping mapping{{10, 20}, 4};
  EXPECT_EQ(to_screen(mapping, {0, 0}), Vector2d(12, 22));
  EXPECT_EQ(to_screen(mapping, {-0.5, -0.5}), Vector2d(10, 20));
  EXPECT_LT((to_image(mapping, to_screen(mapping, {3.25, 7.5})) - Vector2d(3.25, 7.5)).norm(),
            1e-12);
}

TEST(ImageZoom, KeepsThePointUnderThePointer) {
  ImageZoom zoom;
  const Vector2d pointer(700, 300);
  const Vector2d before = to_image(map_image(kZoomedCamera, kZoomedRect, zoom), pointer);
  for (int i = 0; i < 5; ++i) zoom = zoom_about(zoom, kZoomedCamera, kZoomedRect, pointer, 1.3);
  const ImageMapping mapping = map_image(kZoomedCamera, kZoomedRect, zoom);
  // The image's corner is rounded to a whole screen pixel.
  EXPECT_LT((to_image(mapping, pointer) - before).norm(), 1 / mapping.scale);
  EXPECT_NEAR(zoom.factor, std::pow(1.3, 5), 1e-9);
  EXPECT_EQ(zoom_about(zoom, kZoomedCamera, kZoomedRect, pointer, 1e-9).factor, 1);
}

TEST(ImageZoom, PanFollowsThePointer) {
  const ImageZoom zoom{4, {0.5, 0.5}};
  const auto center_on_screen = [](const ImageZoom& shown) {
    return to_screen(map_image(kZoomedCamera, kZoomedRect, shown), {320, 240});
  };
  const ImageZoom moved = pan(zoom, kZoomedCamera, kZoomedRect, {30, -12});
  EXPECT_EQ(center_on_screen(moved) - center_on_screen(zoom), Vector2d(30, -12));
}

TEST(ImageMapping, UndistortsAsOpenCvDoes) {
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

const ScreenRect kDiscRect{{100, 50}, {400, 300}};

TEST(NormalsZoom, MappingFitsTheDiscAndIsInvertible) {
  const DiscMapping all = map_disc(kDiscRect, {});
  EXPECT_EQ(all.to_screen({0, 0}), Vector2d(300, 200));
  EXPECT_LT(all.radius, 150) << "rim and labels fit";
  const DiscMapping zoomed = map_disc(kDiscRect, {20, {0.3, -0.2}});
  EXPECT_LT((zoomed.to_screen({0.3, -0.2}) - Vector2d(300, 200)).norm(), 1e-9);
  EXPECT_LT((zoomed.to_disc(zoomed.to_screen({0.31, -0.25})) - Vector2d(0.31, -0.25)).norm(),
            1e-12);
}

TEST(NormalsZoom, KeepsThePointUnderThePointer) {
  const Vector2d pointer(340, 170);
  const Vector2d before = map_disc(kDiscRect, {}).to_disc(pointer);
  const NormalsZoom zoom = zoom_about({}, kDiscRect, pointer, 8);
  EXPECT_DOUBLE_EQ(zoom.factor, 8);
  EXPECT_LT((map_disc(kDiscRect, zoom).to_disc(pointer) - before).norm(), 1e-9);
  const NormalsZoom all = zoom_about(zoom, kDiscRect, pointer, 1e-9);
  EXPECT_EQ(all.factor, 1);
  EXPECT_EQ(all.center, Vector2d(0, 0));
  EXPECT_EQ(zoom_about(zoom, kDiscRect, pointer, 1e9).factor, kLargestNormalsZoom);
}

TEST(NormalsZoom, PanMovesByScreenPixelsAndKeepsTheDiscInView) {
  const NormalsZoom zoom{10, {0.1, 0.1}};
  const auto on_screen = [](const NormalsZoom& shown) {
    return map_disc(kDiscRect, shown).to_screen({0.12, 0.1});
  };
  const NormalsZoom moved = pan(zoom, kDiscRect, {15, -7});
  EXPECT_LT((on_screen(moved) - on_screen(zoom) - Vector2d(15, -7)).norm(), 1e-9);
  EXPECT_LE(pan(zoom, kDiscRect, {1e6, 0}).center.norm(), 1 + 1e-12);
}

}  // namespace
}  // namespace gpo
