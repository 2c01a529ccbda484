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

/// Only a board on a small desk, in 640x480.
Recipe board_recipe(Distortion distortion) {
  Recipe recipe = recipe_of(small_recipe_text());
  recipe.camera = {640, 480, 500, 496, 322.3, 238.4, distortion, {}};
  if (distortion == Distortion::radial_tangential)
    recipe.camera.coefficients = {0.1, -0.2, 0.001, -0.001};
  if (distortion == Distortion::equidistant) recipe.camera.coefficients = {0.02, -0.01, 0.003, 0};
  recipe.desk.boxes.clear();
  recipe.desk.prints.clear();
  recipe.desk.board = {9, 6, 0.025, 0.015, {0.01, -0.01}, 0.1};
  return recipe;
}

/// Image with the blur of a phone: on edges as sharp as a pixel cornerSubPix itself is 0.05 px off.
cv::Mat exposed(const cv::Mat& light) {
  ImageRecipe image;
  image.blur = 0.6;
  return expose(light, image, 1, 1, 2);
}

Pose pose_at(const Recipe& recipe, double seconds) {
  return camera_motion(recipe.trajectory, seconds).pose;
}

/// The scene of a recipe as its first frame shows it, with one ray a pixel.
cv::Mat first_light(const Recipe& recipe) {
  return render(make_scene(recipe, 2), make_ray_map(recipe.camera, 1, 2), {pose_at(recipe, 0)}, 2);
}

cv::Vec3f light_at(const cv::Mat& light, const Recipe& recipe, const Eigen::Vector3d& point) {
  const Eigen::Vector2d px = project(recipe.camera, to_camera(pose_at(recipe, 0), point));
  return light.at<cv::Vec3f>(cvRound(px.y()), cvRound(px.x()));
}

TEST(Renderer, ShowsCornersWhereTheCameraProjectsThem) {
  for (const auto lens :
       {Distortion::none, Distortion::radial_tangential, Distortion::equidistant}) {
    SCOPED_TRACE(static_cast<int>(lens));
    const Recipe recipe = board_recipe(lens);
    const Scene scene = make_scene(recipe, 2);
    const RayMap rays = make_ray_map(recipe.camera, 4, 2);
    for (const double t : {0.0, 0.06}) {
      const Pose pose = pose_at(recipe, t);
      expect_board(recipe, pose, exposed(render(scene, rays, {pose}, 2)));
    }
  }
}

TEST(Renderer, CentersMotionBlurAtTheTimeStamp) {
  const Recipe recipe = board_recipe(Distortion::radial_tangential);
  const Scene scene = make_scene(recipe, 2);
  const RayMap rays = make_ray_map(recipe.camera, 4, 2);
  std::vector<Pose> poses;
  for (int k = 0; k < 16; ++k)
    poses.push_back(pose_at(recipe, 0.05 + 0.005 * ((k + 0.5) / 16 - 0.5)));
  const Pose middle = pose_at(recipe, 0.05);
  const cv::Mat blurred = render(scene, rays, poses, 2);
  const cv::Mat sharp = render(scene, rays, {middle}, 2);
  EXPECT_GT(cv::norm(blurred, sharp, cv::NORM_INF), 20);  // the camera moves by some pixels
  expect_board(recipe, middle, exposed(blurred));
}

TEST(Renderer, ShowsABoxInFrontOfTheDesk) {
  Recipe recipe = board_recipe(Distortion::none);
  recipe.desk.board.reset();
  const cv::Mat without = first_light(recipe);
  recipe.desk.boxes = {{"cube", {0.0, 0.05}, {0.06, 0.05, 0.08}, 0.4, 0}};
  const cv::Mat with = first_light(recipe);
  // The middle of the top face, and a desk point far from the box and its shadow.
  const cv::Mat top = make_scene(recipe, 2).boxes[0].top;
  const cv::Vec3f middle = top.at<cv::Vec3b>(top.rows / 2, top.cols / 2);
  EXPECT_LT(cv::norm(light_at(with, recipe, {0.0, 0.05, 0.08}), middle), 3);
  const Eigen::Vector3d far(-0.2, -0.05, 0);
  EXPECT_LT(cv::norm(light_at(with, recipe, far), light_at(without, recipe, far)), 3);
}

cv::Mat chessboard() {
  constexpr int kSquare = 100;
  cv::Mat texture(6 * kSquare, 8 * kSquare, CV_8UC3);
  for (int row = 0; row < texture.rows; ++row)
    for (int col = 0; col < texture.cols; ++col)
      texture.at<cv::Vec3b>(row, col) =
          cv::Vec3b::all((row / kSquare + col / kSquare) % 2 == 0 ? 40 : 220);
  return texture;
}

TEST(Renderer, ShowsPointsOfAWallWhereTheCameraProjectsThem) {
  Recipe recipe = board_recipe(Distortion::radial_tangential);
  recipe.desk.board.reset();
  const WallRecipe wall{{-0.22, 0.02}, {0.16, 0.16}, 0.18};
  recipe.desk.walls = {wall};
  Scene scene = make_scene(recipe, 2);
  ASSERT_EQ(scene.walls.size(), 1U);
  scene.walls[0].texture = chessboard();
  const Pose pose = pose_at(recipe, 0);
  const RayMap rays = make_ray_map(recipe.camera, 4, 2);
  std::vector<Eigen::Vector2d> projections;
  for (int row = 1; row < 6; ++row)
    for (int column = 1; column < 8; ++column) {
      const Eigen::Vector2d foot = wall.from + (wall.to - wall.from) * (column / 8.0);
      const Eigen::Vector3d corner(foot.x(), foot.y(), wall.height * row / 6.0);
      const Eigen::Vector2d px = project(recipe.camera, to_camera(pose, corner));
      ASSERT_TRUE(cv::Rect2d(10, 10, 620, 460).contains({px.x(), px.y()})) << px;
      projections.push_back(px);
    }
  // On a slanted board cornerSubPix itself is some hundredths of a pixel off, to all sides.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& error :
       gpo::corner_errors(exposed(render(scene, rays, {pose}, 2)), projections, 5)) {
    EXPECT_LT(error.norm(), 0.1);
    sum += error;
  }
  EXPECT_LT(sum.norm() / static_cast<double>(projections.size()), 0.02);
}

TEST(Renderer, ShowsPrintsOfAWallAndHidesThingsBehindIt) {
  Recipe recipe = board_recipe(Distortion::none);
  recipe.desk.board.reset();
  recipe.desk.walls = {WallRecipe{{-0.2, 0.1}, {0.2, 0.1}, 0.15}};
  const cv::Mat bare = first_light(recipe);
  recipe.desk.walls[0].prints = {{"photo", {0.1, 0.09}, {0.1, 0.06}, 0}};
  const cv::Mat hung = first_light(recipe);
  recipe.desk.boxes = {{"cube", {-0.1, 0.3}, {0.05, 0.05, 0.05}, 0, 0}};
  const cv::Mat hiding = first_light(recipe);
  const auto change = [&](const cv::Mat& a, const cv::Mat& b, const Eigen::Vector3d& point) {
    return cv::norm(light_at(a, recipe, point), light_at(b, recipe, point));
  };
  // The photograph has a white rim.
  for (const double x : {-0.147, -0.053}) EXPECT_GT(change(bare, hung, {x, 0.1, 0.09}), 20) << x;
  for (const double z : {0.063, 0.117}) EXPECT_GT(change(bare, hung, {-0.1, 0.1, z}), 20) << z;
  EXPECT_EQ(change(bare, hung, {0.1, 0.1, 0.09}), 0);
  EXPECT_EQ(change(hung, hiding, {-0.1, 0.275, 0.02}), 0);
}

TEST(Renderer, CoversThePixelsWithRaysThroughARock) {
  const Recipe recipe = board_recipe(Distortion::none);
  const Pose pose = pose_at(recipe, 0);
  // A blue sphere with a cut, without a desk.
  SceneRock rock;
  rock.center = {0.03, 0.05, 0.1};
  rock.reach = 0.07;
  rock.R_unit_world = Eigen::Matrix3d::Identity() / rock.reach;
  const SceneRock::Cut cut{Eigen::Vector3d(1, 0.2, 0.5).normalized(), 0.4};
  rock.cuts = {cut};
  rock.tint = {1, 0, 0};
  Scene scene;
  scene.stone = cv::Mat(std::vector{144, 144, 144}, CV_8UC1, cv::Scalar(255));
  scene.rocks = {rock};
  const cv::Mat image = render(scene, make_ray_map(recipe.camera, 1, 2), {pose}, 2);
  int covered = 0, wrong = 0;
  for (int row = 0; row < image.rows; ++row)
    for (int col = 0; col < image.cols; ++col) {
      const Eigen::Vector3d along =
          (pose.R_wc * Eigen::Vector3d((col - recipe.camera.cx) / recipe.camera.fx,
                                       (row - recipe.camera.cy) / recipe.camera.fy,
                                       1))
              .normalized();
      // The ray meets the rock if an end of its chord is within the half-space.
      const Eigen::Vector3d from = pose.p_wc - rock.center;
      const double middle = -from.dot(along);
      const double half2 = rock.reach * rock.reach - (from + middle * along).squaredNorm();
      bool meets = false;
      for (const double end : {-1.0, 1.0}) {
        if (half2 < 0) continue;
        const Eigen::Vector3d p = from + (middle + end * std::sqrt(half2)) * along;
        meets = meets || cut.normal.dot(p) / rock.reach <= cut.distance;
      }
      covered += meets ? 1 : 0;
      // The room behind the rock is gray.
      wrong += meets != (image.at<cv::Vec3f>(row, col)[2] < 1) ? 1 : 0;
    }
  EXPECT_GT(covered, 2000);
  EXPECT_EQ(wrong, 0);
}

TEST(Renderer, AddsNoiseOfTheStrengthInTheRecipe) {
  const cv::Mat light(200, 300, CV_32FC3, cv::Scalar(120, 120, 120));
  ImageRecipe image;
  const cv::Mat clean = expose(light, image, 1, 5, 2);
  image.noise = 3;
  const cv::Mat noisy = expose(light, image, 1, 5, 2);
  cv::Mat difference;
  cv::subtract(noisy, clean, difference, {}, CV_32FC3);
  cv::Scalar mean, deviation;
  cv::meanStdDev(difference, mean, deviation);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k], 0, 0.06);
    EXPECT_NEAR(deviation[k], 3, 0.08);
  }
  EXPECT_GT(cv::norm(noisy, expose(light, image, 1, 6, 2)), 0);
}

}  // namespace
}  // namespace gpo
