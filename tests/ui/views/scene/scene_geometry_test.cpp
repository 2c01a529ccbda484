// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_geometry.h"

#include "engine/inspection/studies/plane_patches.h"
#include "engine/truth/truth.h"
#include "tests/ui/made_inspection.h"

#include <cmath>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

void expect_truth_on_the_estimate(const Inspection& inspection) {
  const auto T_est_true = estimate_from_truth(inspection);
  ASSERT_TRUE(T_est_true);
  for (int i = 0; i < inspection.window->frame_count(); ++i) {
    const auto pose = true_camera(inspection, *T_est_true, i);
    ASSERT_TRUE(pose);
    EXPECT_LT((pose->p_wc - inspection.initialization->cameras[i].p_wc).norm(), 1e-9);
    EXPECT_LT((pose->R_wc - inspection.initialization->cameras[i].R_wc).norm(), 1e-9);
  }
}

TEST(SceneGeometry, TruthMeetsAPerfectEstimateByTheAlignedPaths) {
  expect_truth_on_the_estimate(made_inspection());
}

TEST(SceneGeometry, TruthMeetsAPerfectEstimateByTheReferenceCameraWhereThePathIsALine) {
  Inspection inspection = made_inspection();
  inspection.evaluation->alignment = Alignment::line;
  inspection.evaluation->T_true_est->R_ab.setIdentity();
  expect_truth_on_the_estimate(inspection);
}

TEST(SceneGeometry, TruthMeetsAPerfectEstimateByThePlanesDistanceWhereThePathIsAPoint) {
  Inspection inspection = made_inspection();
  inspection.evaluation = Evaluation{};
  inspection.evaluation->alignment = Alignment::point;
  expect_truth_on_the_estimate(inspection);
}

TEST(SceneGeometry, TruthWithoutAnyScaleIsNotDrawn) {
  Inspection inspection = made_inspection();
  auto truth = std::make_shared<WindowTruth>(*inspection.truth);
  truth->plane.reset();
  inspection.truth = truth;
  inspection.evaluation.reset();
  EXPECT_FALSE(estimate_from_truth(inspection));
  EXPECT_FALSE(estimate_from_truth(made_inspection({.truth = false})));
}

TEST(SceneGeometry, TruePlanesBorderLiesOnTheEstimateOfAPerfectOne) {
  const Inspection inspection = made_inspection();
  const PlaneGrid grid = plane_grid(inspection, 0.2);
  const auto border = true_plane_border(inspection, *estimate_from_truth(inspection), grid);
  ASSERT_TRUE(border);
  const Plane& plane = inspection.initialization->plane;
  for (const Vector3d& corner : *border)
    EXPECT_NEAR(plane.normal.dot(corner) + plane.distance, 0, 1e-9);
}

TEST(SceneGeometry, GridContainsTheCubeAndLiesOnThePlane) {
  const Inspection inspection = made_inspection({.estimate_error = 4});
  const PlaneGrid grid = plane_grid(inspection, 0.2);
  const Plane& plane = inspection.initialization->plane;
  EXPECT_NEAR(plane.normal.dot(grid.at(3, -2)) + plane.distance, 0, 1e-12);
  EXPECT_NEAR(grid.x.dot(grid.y), 0, 1e-12);
  for (const Vector3d& corner : cube_corners(*inspection.cube, 0.2)) {
    const double i = grid.x.dot(corner - grid.origin) / grid.cell;
    const double j = grid.y.dot(corner - grid.origin) / grid.cell;
    EXPECT_TRUE(i > grid.low[0] && i < grid.high[0] && j > grid.low[1] && j < grid.high[1]);
  }
}

TEST(SceneGeometry, FrustumsCornersAreTheImagesCorners) {
  const Camera camera{640, 480, 500, 505, 322, 236, Distortion::none, {}};
  const auto corners = frustum(camera, Pose(), 0.3);
  EXPECT_LT((project(camera, corners[1]) - Vector2d(-0.5, -0.5)).norm(), 1e-9);
  EXPECT_LT((project(camera, corners[3]) - Vector2d(639.5, 479.5)).norm(), 1e-9);
  EXPECT_NEAR(corners[2].z(), 0.3, 1e-12);
  EXPECT_LT(project(camera, corners[5]).y(), -1);  // the mark is above the picture
}

TEST(SceneGeometry, DefaultViewShowsEverythingFromAboveThePlane) {
  for (const MadeOptions& made : {MadeOptions{},
                                  MadeOptions{.truth = false},
                                  MadeOptions{.ok = false},
                                  MadeOptions{.refused = true}}) {
    const Inspection inspection = made_inspection(made);
    const OrbitCamera camera = default_scene_camera(inspection, 0.2, 4.0 / 3);
    for (const Vector3d& point : scene_extent(inspection, 0.2)) {
      const auto pixel = view_pixel(camera, point, {960, 720});
      ASSERT_TRUE(pixel);
      EXPECT_TRUE(pixel->minCoeff() > 0 && pixel->x() < 960 && pixel->y() < 720);
    }
  }
  const Inspection inspection = made_inspection();
  const Plane& plane = inspection.initialization->plane;
  const Vector3d at = eye(default_scene_camera(inspection, 0.2, 1));
  EXPECT_GT(plane.normal.dot(at) + plane.distance, 0);
}

TEST(SceneGeometry, OfARefusedSolutionShowsWhatWasFound) {
  const Inspection found = made_inspection(), inspection = made_inspection({.refused = true});
  EXPECT_FALSE(inspection.initialization->ok);
  const auto& cameras = found_cameras(*inspection.initialization);
  ASSERT_EQ(cameras.size(), found.initialization->cameras.size());
  EXPECT_EQ(cameras.back().p_wc, found.initialization->cameras.back().p_wc);
  const auto patch = refused_patch(inspection);
  ASSERT_TRUE(patch);
  const Plane& plane = found.initialization->plane;
  for (const Vector3d& corner : patch->corners)
    EXPECT_NEAR(plane.normal.dot(corner) + plane.distance, 0, 1e-9);
  EXPECT_TRUE(found_cameras(*made_inspection({.ok = false}).initialization).empty());
  EXPECT_FALSE(refused_patch(made_inspection({.ok = false})));
}

TEST(SceneGeometry, ViewpointsLookWhereTheySayAndShowEverything) {
  const Inspection inspection = made_inspection();
  const Vector3d& up = inspection.initialization->plane.normal;
  const auto forward = [&](Viewpoint viewpoint) {
    const OrbitCamera camera = scene_camera(inspection, 0.2, 1.5, viewpoint, 24);
    for (const Vector3d& point : scene_extent(inspection, 0.2)) {
      const auto pixel = view_pixel(camera, point, {900, 600});
      EXPECT_TRUE(pixel && pixel->minCoeff() > 0 && pixel->x() < 900 && pixel->y() < 600);
    }
    return Vector3d(view_axes(camera).col(2));
  };
  EXPECT_LT(forward(Viewpoint::top).dot(up), -0.999);
  const Vector3d front = forward(Viewpoint::front), side = forward(Viewpoint::side);
  EXPECT_NEAR(front.dot(up), 0, 1e-9);
  EXPECT_NEAR(side.dot(up), 0, 1e-9);
  EXPECT_NEAR(side.dot(front), 0, 1e-9);
  EXPECT_GT(front.z(), 0);  // as the reference camera looks
}

TEST(SceneGeometry, ThroughTheCameraPointsAreWhereItSeesThem) {
  const Inspection inspection = made_inspection();
  const Camera& lens = inspection.recording->camera;
  const int start = inspection.window->start;
  const Pose& pose = inspection.initialization->cameras[3];
  const OrbitCamera camera =
      scene_camera(inspection, 0.2, double(lens.width) / lens.height, Viewpoint::camera, start + 3);
  EXPECT_LT((eye(camera) - pose.p_wc).norm(), 1e-9);
  const Vector2d size(lens.width, lens.height);
  for (const MapPoint& point : inspection.initialization->points) {
    const Vector3d c = to_camera(pose, point.position);
    const Vector2d pinhole(lens.fx * c.x() / c.z() + size.x() / 2,
                           lens.fy * c.y() / c.z() + size.y() / 2);
    // The view may be a little wider than the picture, so that all of it is in sight.
    const Vector2d seen = *view_pixel(camera, point.position, size);
    EXPECT_LT((seen - pinhole).norm(), 0.03 * (pinhole - size / 2).norm() + 1e-6);
  }
}

TEST(SceneGeometry, NiceLengthsAreOneTwoFive) {
  EXPECT_DOUBLE_EQ(nice_length(0.07), 0.05);
  EXPECT_DOUBLE_EQ(nice_length(1), 1);
  EXPECT_DOUBLE_EQ(nice_length(4.9), 2);
  EXPECT_DOUBLE_EQ(nice_length(999), 500);
}

}  // namespace
}  // namespace gpo
