// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/synthesis/renderer.h"

#include "engine/window/tracks.h"
#include "tests/engine/synthesis/small_recipe.h"

#include <array>
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
ImageRecipe clean_image() {
  ImageRecipe image;
  image.blur = 0.6;
  return image;
}

class RendererLens : public testing::TestWithParam<Distortion> {};

TEST_P(RendererLens, CornersAreWhereTheCameraProjectsThem) {
  const Recipe recipe = board_recipe(GetParam());
  const Scene scene = make_scene(recipe, 2);
  const RayMap rays = make_ray_map(recipe.camera, 4, 2);
  for (const double t : {0.0, 0.06}) {
    const Pose pose = camera_motion(recipe.trajectory, t).pose;
    const cv::Mat image = expose(render(scene, rays, {pose}, 2), clean_image(), 1, 1, 2);
    const CornerError error = corner_error(recipe, pose, image);
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
  const Scene scene = make_scene(recipe, 2);
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
  const CornerError error = corner_error(recipe, middle, expose(blurred, clean_image(), 1, 1, 2));
  EXPECT_LT(error.rms, 0.05);
  EXPECT_LT(error.mean, 0.015);
}

TEST(Renderer, BoxHidesWhatIsBehindItAndStandsWhereTheRecipeSays) {
  Recipe recipe = board_recipe(Distortion::none);
  recipe.desk.board.reset();
  const Pose pose = camera_motion(recipe.trajectory, 0).pose;
  const RayMap rays = make_ray_map(recipe.camera, 1, 2);
  const cv::Mat without = render(make_scene(recipe, 2), rays, {pose}, 2);
  recipe.desk.boxes = {{"cube", {0.0, 0.05}, {0.06, 0.05, 0.08}, 0.4, 0}};
  const Scene scene = make_scene(recipe, 2);
  const cv::Mat with = render(scene, rays, {pose}, 2);
  const auto at = [&](const cv::Mat& image, const Eigen::Vector3d& point) {
    const Eigen::Vector2d px = project(recipe.camera, to_camera(pose, point));
    return image.at<cv::Vec3f>(cvRound(px.y()), cvRound(px.x()));
  };
  // The middle of the top face, and a desk point far from the box and its shadow.
  const auto& top = scene.boxes[0].top;
  const cv::Vec3f middle = top.at<cv::Vec3b>(top.rows / 2, top.cols / 2);
  EXPECT_LT(cv::norm(at(with, {0.0, 0.05, 0.08}), middle), 3);
  EXPECT_LT(cv::norm(at(with, {-0.2, -0.05, 0}), at(without, {-0.2, -0.05, 0})), 3);
}

/// A chessboard of 8 x 6 squares that fills a texture.
cv::Mat chessboard() {
  constexpr int kSquare = 100;
  cv::Mat texture(6 * kSquare, 8 * kSquare, CV_8UC3);
  for (int row = 0; row < texture.rows; ++row) {
    for (int col = 0; col < texture.cols; ++col) {
      const int parity = (row / kSquare + col / kSquare) % 2;
      texture.at<cv::Vec3b>(row, col) = cv::Vec3b::all(parity == 0 ? 40 : 220);
    }
  }
  return texture;
}

TEST(Renderer, WallsPointsAreWhereTheCameraProjectsThem) {
  Recipe recipe = board_recipe(Distortion::radial_tangential);
  recipe.desk.board.reset();
  WallRecipe wall;
  wall.from = {-0.22, 0.02};
  wall.to = {0.16, 0.16};
  wall.height = 0.18;
  recipe.desk.walls = {wall};
  Scene scene = make_scene(recipe, 2);
  ASSERT_EQ(scene.walls.size(), 1U);
  scene.walls[0].texture = chessboard();
  const Pose pose = camera_motion(recipe.trajectory, 0).pose;
  const RayMap rays = make_ray_map(recipe.camera, 4, 2);
  const cv::Mat image = expose(render(scene, rays, {pose}, 2), clean_image(), 1, 1, 2);
  std::vector<cv::Point2f> corners;
  std::vector<Eigen::Vector2d> projections;
  for (int row = 1; row < 6; ++row) {
    for (int column = 1; column < 8; ++column) {
      const Eigen::Vector2d foot = wall.from + (wall.to - wall.from) * (column / 8.0);
      const Eigen::Vector3d corner(foot.x(), foot.y(), wall.height * row / 6.0);
      projections.push_back(project(recipe.camera, to_camera(pose, corner)));
      corners.emplace_back(static_cast<float>(projections.back().x()),
                           static_cast<float>(projections.back().y()));
      ASSERT_TRUE(cv::Rect(10, 10, 620, 460).contains(corners.back())) << corners.back();
    }
  }
  cv::Mat gray;
  cv::cvtColor(image, gray, cv::COLOR_BGR2GRAY);
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-4);
  cv::cornerSubPix(gray, corners, {5, 5}, {-1, -1}, criteria);
  // On a slanted board cornerSubPix itself is some hundredths of a pixel off, to all sides.
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d error = Eigen::Vector2d(corners[i].x, corners[i].y) - projections[i];
    EXPECT_LT(error.norm(), 0.1) << i;
    sum += error;
  }
  EXPECT_LT(sum.norm() / static_cast<double>(corners.size()), 0.02);
}

TEST(Renderer, WallHangsItsPrintsWhereTheRecipeSaysAndHidesWhatIsBehind) {
  Recipe recipe = board_recipe(Distortion::none);
  recipe.desk.board.reset();
  const RayMap rays = make_ray_map(recipe.camera, 1, 2);
  const Pose pose = camera_motion(recipe.trajectory, 0).pose;
  WallRecipe wall;
  wall.from = {-0.2, 0.1};
  wall.to = {0.2, 0.1};
  wall.height = 0.15;
  recipe.desk.walls = {wall};
  const cv::Mat bare = render(make_scene(recipe, 2), rays, {pose}, 2);
  recipe.desk.walls[0].prints = {{"photo", {0.1, 0.09}, {0.1, 0.06}, 0}};
  const cv::Mat hung = render(make_scene(recipe, 2), rays, {pose}, 2);
  recipe.desk.boxes = {{"cube", {-0.1, 0.3}, {0.05, 0.05, 0.05}, 0, 0}};
  const cv::Mat hiding = render(make_scene(recipe, 2), rays, {pose}, 2);
  const auto change = [&](const cv::Mat& a, const cv::Mat& b, const Eigen::Vector3d& point) {
    const Eigen::Vector2d px = project(recipe.camera, to_camera(pose, point));
    const cv::Point at(cvRound(px.x()), cvRound(px.y()));
    return cv::norm(a.at<cv::Vec3f>(at), b.at<cv::Vec3f>(at));
  };
  // The photograph's white rim is just inside its edges.
  for (const double x : {-0.147, -0.053}) EXPECT_GT(change(bare, hung, {x, 0.1, 0.09}), 20) << x;
  for (const double z : {0.063, 0.117}) EXPECT_GT(change(bare, hung, {-0.1, 0.1, z}), 20) << z;
  EXPECT_EQ(change(bare, hung, {0.1, 0.1, 0.09}), 0);
  EXPECT_EQ(change(hung, hiding, {-0.1, 0.275, 0.02}), 0);
}

/// A sphere of which the part beyond a plane is cut off, in space without a desk.
Scene cut_sphere(const Eigen::Vector3d& center, double radius, const SceneRock::Cut& cut) {
  Scene scene;
  const std::array<int, 3> sizes = {144, 144, 144};
  scene.stone = cv::Mat(3, sizes.data(), CV_8UC1, cv::Scalar(255));
  SceneRock rock;
  rock.center = center;
  rock.R_unit_world = Eigen::Matrix3d::Identity() / radius;
  rock.reach = radius;
  rock.cuts = {cut};
  rock.tint = {1, 0, 0};
  scene.rocks = {rock};
  return scene;
}

TEST(Renderer, RockCoversThePixelsWhoseRaysMeetIt) {
  const Recipe recipe = board_recipe(Distortion::none);
  const Pose pose = camera_motion(recipe.trajectory, 0).pose;
  const Eigen::Vector3d center(0.03, 0.05, 0.1);
  const SceneRock::Cut cut{Eigen::Vector3d(1, 0.2, 0.5).normalized(), 0.4};
  const Scene scene = cut_sphere(center, 0.07, cut);
  const cv::Mat image = render(scene, make_ray_map(recipe.camera, 1, 2), {pose}, 2);
  int covered = 0;
  int wrong = 0;
  for (int row = 0; row < image.rows; ++row) {
    for (int col = 0; col < image.cols; ++col) {
      const Eigen::Vector3d along =
          (pose.R_wc * Eigen::Vector3d((col - recipe.camera.cx) / recipe.camera.fx,
                                       (row - recipe.camera.cy) / recipe.camera.fy,
                                       1))
              .normalized();
      // The chord within the sphere has a point within the half-space, or the ray misses.
      const Eigen::Vector3d from = pose.p_wc - center;
      const double middle = -from.dot(along);
      const double half2 = 0.07 * 0.07 - (from + middle * along).squaredNorm();
      bool meets = false;
      for (const double end : {-1.0, 1.0}) {
        if (half2 < 0) continue;
        const Eigen::Vector3d p = from + (middle + end * std::sqrt(half2)) * along;
        meets = meets || cut.normal.dot(p) / 0.07 <= cut.distance;
      }
      covered += meets ? 1 : 0;
      // The rock is blue, the room beyond is gray.
      const cv::Vec3f color = image.at<cv::Vec3f>(row, col);
      wrong += meets != (color[2] < 1) ? 1 : 0;
    }
  }
  EXPECT_GT(covered, 2000);
  EXPECT_EQ(wrong, 0);
}

TEST(Renderer, NoiseHasTheRecipesStrength) {
  const cv::Mat light(200, 300, CV_32FC3, cv::Scalar(120, 120, 120));
  ImageRecipe image;
  const cv::Mat clean = expose(light, image, 1, 5, 2);
  image.noise = 3;
  const cv::Mat noisy = expose(light, image, 1, 5, 2);
  cv::Mat difference;
  cv::subtract(noisy, clean, difference, {}, CV_32FC3);
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(difference, mean, deviation);
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(mean[k], 0, 0.06);
    EXPECT_NEAR(deviation[k], 3, 0.08);
  }
  EXPECT_GT(cv::norm(noisy, expose(light, image, 1, 6, 2)), 0);
}

}  // namespace
}  // namespace gpo
