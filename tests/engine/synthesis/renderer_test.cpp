// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/renderer.h"

#include "engine/window/tracks.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

/// The board alone on a small desk, in 640x480.
Recipe board_recipe(Distortion distortion) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.camera = {640, 480, 500, 496, 322.3, 238.4, distortion, {}};
  if (distortion == Distortion::radial_tangential) {
    recipe.camera.coefficients = {0.1, -0.2, 0.001, -0.001};
  }
  if (distortion == Distortion::equidistant) recipe.camera.coefficients = {0.02, -0.01, 0.003, 0};
  recipe.desk.boxes.clear();
  recipe.desk.prints.clear();
  recipe.desk.board = {9, 6, 0.025, 0.015, {0.01, -0.01}, 0.1};
  return recipe;
}

/// The lens of a phone: on edges as sharp as a pixel cornerSubPix itself is 0.05 px off.
PictureRecipe clean_picture() {
  PictureRecipe picture;
  picture.blur = 0.6;
  return picture;
}

class RendererLens : public testing::TestWithParam<Distortion> {};

TEST_P(RendererLens, CornersAreWhereTheCameraProjectsThem) {
  const Recipe recipe = board_recipe(GetParam());
  const Scene scene = make_scene(recipe.desk, 2);
  const RayMap rays = make_ray_map(recipe.camera, 4, 2);
  for (const double t : {0.0, 0.06}) {
    const Pose pose = camera_motion(recipe.trajectory, t).pose;
    const cv::Mat picture = expose(render(scene, rays, {pose}, 2), clean_picture(), 1, 1, 2);
    const CornerError error = corner_error(recipe, pose, picture);
    EXPECT_LT(error.rms, 0.05);
    EXPECT_LT(error.mean, 0.015);
  }
}

INSTANTIATE_TEST_SUITE_P(Lenses,
                         RendererLens,
                         testing::Values(Distortion::none,
                                         Distortion::radial_tangential,
                                         Distortion::equidistant));

TEST(Renderer, MotionBlurIsCenteredAtTheTimeStamp) {
  const Recipe recipe = board_recipe(Distortion::radial_tangential);
  const Scene scene = make_scene(recipe.desk, 2);
  const RayMap rays = make_ray_map(recipe.camera, 4, 2);
  std::vector<Pose> poses;
  poses.reserve(16);
  for (int k = 0; k < 16; ++k) {
    poses.push_back(camera_motion(recipe.trajectory, 0.05 + 0.005 * ((k + 0.5) / 16 - 0.5)).pose);
  }
  const Pose middle = camera_motion(recipe.trajectory, 0.05).pose;
  const cv::Mat blurred = render(scene, rays, poses, 2);
  const cv::Mat sharp = render(scene, rays, {middle}, 2);
  EXPECT_GT(cv::norm(blurred, sharp, cv::NORM_INF), 20);  // The camera moves by some pixels.
  const CornerError error = corner_error(recipe, middle, expose(blurred, clean_picture(), 1, 1, 2));
  EXPECT_LT(error.rms, 0.05);
  EXPECT_LT(error.mean, 0.015);
}

TEST(Renderer, BoxHidesWhatIsBehindItAndStandsWhereTheRecipeSays) {
  Recipe recipe = board_recipe(Distortion::none);
  recipe.desk.board.reset();
  const Pose pose = camera_motion(recipe.trajectory, 0).pose;
  const RayMap rays = make_ray_map(recipe.camera, 1, 2);
  const cv::Mat without = render(make_scene(recipe.desk, 2), rays, {pose}, 2);
  recipe.desk.boxes = {{"cube", {0.0, 0.05}, {0.06, 0.05, 0.08}, 0.4, 0}};
  const Scene scene = make_scene(recipe.desk, 2);
  const cv::Mat with = render(scene, rays, {pose}, 2);
  const auto at = [&](const cv::Mat& picture, const Eigen::Vector3d& point) {
    const Eigen::Vector2d px = project(recipe.camera, to_camera(pose, point));
    return picture.at<cv::Vec3f>(cvRound(px.y()), cvRound(px.x()));
  };
  // The middle of the top face, and a desk point far from the box and its shadow.
  const auto& top = scene.boxes[0].top;
  const cv::Vec3f middle = top.at<cv::Vec3b>(top.rows / 2, top.cols / 2);
  EXPECT_LT(cv::norm(at(with, {0.0, 0.05, 0.08}), middle), 3);
  EXPECT_LT(cv::norm(at(with, {-0.2, -0.05, 0}), at(without, {-0.2, -0.05, 0})), 3);
}

TEST(Renderer, NoiseHasTheRecipesStrength) {
  const cv::Mat light(200, 300, CV_32FC3, cv::Scalar(120, 120, 120));
  PictureRecipe picture;
  const cv::Mat clean = expose(light, picture, 1, 5, 2);
  picture.noise = 3;
  const cv::Mat noisy = expose(light, picture, 1, 5, 2);
  cv::Mat difference;
  cv::subtract(noisy, clean, difference, {}, CV_32FC3);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(difference, mean, deviation);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k], 0, 0.06);
    EXPECT_NEAR(deviation[k], 3, 0.08);
  }
  EXPECT_GT(cv::norm(noisy, expose(light, picture, 1, 6, 2)), 0);
}

}  // namespace
}  // namespace gpo
