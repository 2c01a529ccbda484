// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_geometry.h"

#include "engine/inspection/studies/planes.h"
#include "engine/methods/plane/normal_landscape.h"
#include "engine/truth/truth.h"
#include "tests/ui/made_inspection.h"

#include <cmath>
#include <random>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

template <class Points>
void expect_in_view(const OrbitCamera& camera, const Points& points, const Vector2d& size) {
  for (const Vector3d& point : points) {
    const auto pixel = view_pixel(camera, point, size);
    ASSERT_TRUE(pixel);
    EXPECT_TRUE(pixel->minCoeff() > 0 && (size - *pixel).minCoeff() > 0);
  }
}

template <class Points>
void expect_on(const Plane& plane, const Points& points) {
  for (const Vector3d& point : points)
    EXPECT_NEAR(plane.normal.dot(point) + plane.distance, 0, 1e-9);
}

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

TEST(SceneGeometry, TruthAgreesWithAPerfectEstimate) {
  Inspection inspection = made_inspection();
  expect_truth_on_the_estimate(inspection);
  // By the reference camera and the alignment's scale if the path is a line.
  inspection.evaluation->alignment = Alignment::line;
  inspection.evaluation->T_true_est->R_ab.setIdentity();
  expect_truth_on_the_estimate(inspection);
  // By the plane's distance if it is a point.
  inspection.evaluation = Evaluation{};
  inspection.evaluation->alignment = Alignment::point;
  expect_truth_on_the_estimate(inspection);
}

TEST(SceneGeometry, TruthWithoutScaleIsUnknown) {
  Inspection inspection = made_inspection();
  auto truth = std::make_shared<WindowTruth>(*inspection.truth);
  truth->plane.reset();
  inspection.truth = truth;
  inspection.evaluation.reset();
  EXPECT_FALSE(estimate_from_truth(inspection));
  EXPECT_FALSE(estimate_from_truth(made_inspection({.truth = false})));
}

TEST(SceneGeometry, TruePlanesBorderIsOnAPerfectEstimate) {
  const Inspection inspection = made_inspection();
  const PlaneGrid grid = plane_grid(inspection, 0.2);
  const auto border = true_plane_border(inspection, *estimate_from_truth(inspection), grid);
  ASSERT_TRUE(border);
  expect_on(inspection.initialization->plane, *border);
}

TEST(SceneGeometry, GridIsOnThePlaneAndContainsTheCube) {
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

TEST(SceneGeometry, FrustumHasTheImagesCorners) {
  const Camera camera{640, 480, 500, 505, 322, 236, Distortion::none, {}};
  const auto corners = frustum(camera, Pose(), 0.3);
  EXPECT_LT((project(camera, corners[1]) - Vector2d(-0.5, -0.5)).norm(), 1e-9);
  EXPECT_LT((project(camera, corners[3]) - Vector2d(639.5, 479.5)).norm(), 1e-9);
  EXPECT_NEAR(corners[2].z(), 0.3, 1e-12);
  EXPECT_LT(project(camera, corners[5]).y(), -1) << "the mark is above the image";
}

TEST(SceneGeometry, DefaultViewShowsTheWholeSceneFromAbove) {
  for (const MadeOptions& made : {MadeOptions{},
                                  MadeOptions{.truth = false},
                                  MadeOptions{.ok = false},
                                  MadeOptions{.refused = true}}) {
    const Inspection inspection = made_inspection(made);
    const OrbitCamera camera = default_scene_camera(inspection, 0.2, 4.0 / 3);
    expect_in_view(camera, scene_extent(inspection, 0.2), {960, 720});
  }
  const Inspection inspection = made_inspection();
  const Plane& plane = inspection.initialization->plane;
  const Vector3d at = eye(default_scene_camera(inspection, 0.2, 1));
  EXPECT_GT(plane.normal.dot(at) + plane.distance, 0);
}

TEST(SceneGeometry, ShowsARejectedSolution) {
  const Inspection found = made_inspection(), inspection = made_inspection({.refused = true});
  EXPECT_FALSE(inspection.initialization->ok);
  const auto& cameras = found_cameras(*inspection.initialization);
  ASSERT_EQ(cameras.size(), found.initialization->cameras.size());
  EXPECT_EQ(cameras.back().p_wc, found.initialization->cameras.back().p_wc);
  const auto patch = refused_patch(inspection);
  ASSERT_TRUE(patch);
  expect_on(found.initialization->plane, patch->corners);
  EXPECT_TRUE(found_cameras(*made_inspection({.ok = false}).initialization).empty());
  EXPECT_FALSE(refused_patch(made_inspection({.ok = false})));
}

TEST(SceneGeometry, ViewpointsHaveTheirDirectionsAndShowTheWholeScene) {
  const Inspection inspection = made_inspection();
  const Vector3d& up = inspection.initialization->plane.normal;
  const auto forward = [&](Viewpoint viewpoint) {
    const OrbitCamera camera = scene_camera(inspection, 0.2, 1.5, viewpoint, 24);
    expect_in_view(camera, scene_extent(inspection, 0.2), {900, 600});
    return Vector3d(view_axes(camera).col(2));
  };
  EXPECT_LT(forward(Viewpoint::top).dot(up), -0.999);
  const Vector3d front = forward(Viewpoint::front), side = forward(Viewpoint::side);
  EXPECT_NEAR(front.dot(up), 0, 1e-9);
  EXPECT_NEAR(side.dot(up), 0, 1e-9);
  EXPECT_NEAR(side.dot(front), 0, 1e-9);
  EXPECT_GT(front.z(), 0) << "in the direction of the reference camera";
}

TEST(SceneGeometry, ViewThroughACameraIsItsImage) {
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
    // The view may be a little wider than the image.
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

Matrix3d some_covariance() {
  Matrix3d L;
  L << 0.02, 0, 0, 0.01, 0.005, 0, -0.004, 0.002, 0.01;
  return L * L.transpose();
}

TEST(UncertaintyGeometry, EllipsoidContains95PercentOfCenters) {
  const Matrix3d covariance = some_covariance();
  const Matrix3d L = covariance.llt().matrixL();
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int inside = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Vector3d x = L * Vector3d(normal(random), normal(random), normal(random));
    inside += x.dot(covariance.inverse() * x) <= kChiSquare3 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / kDraws, 0.95, 0.005);
}

TEST(UncertaintyGeometry, LinesAreOnTheEllipsoidAroundTheCenter) {
  const Vector3d center(1, -2, 0.5);
  const Matrix3d information = some_covariance().inverse();
  for (const double enlarged : {1.0, 10.0}) {
    for (const auto& line : confidence_ellipsoid(center, some_covariance(), enlarged)) {
      for (const Vector3d& point : line) {
        const Vector3d from = (point - center) / enlarged;
        EXPECT_NEAR(from.dot(information * from), kChiSquare3, 1e-6);
      }
    }
  }
  for (const auto& line : confidence_ellipsoid(center, Matrix3d::Zero(), 100))
    for (const Vector3d& point : line) EXPECT_EQ(point, center);
}

TEST(UncertaintyGeometry, RimHasTheAnglesOf95Percent) {
  const NormalArrow arrow{Vector3d(1, 2, 3), Vector3d(1, 2, 5)};
  const Matrix3d covariance = Vector3d(1e-4, 4e-4, 0).asDiagonal();
  double least = 10, most = 0;
  for (const Vector3d& end : confidence_rim(arrow, covariance, 1)) {
    EXPECT_NEAR((end - arrow.base).norm(), 2, 1e-9);
    const double angle = std::acos((end - arrow.base).normalized().z());
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  EXPECT_NEAR(least, 0.01 * std::sqrt(kChiSquare2), 1e-6);
  EXPECT_NEAR(most, 0.02 * std::sqrt(kChiSquare2), 1e-6);
}

TEST(UncertaintyGeometry, RimIsLimitedToARightAngle) {
  const NormalArrow arrow{Vector3d::Zero(), Vector3d::UnitZ()};
  const Matrix3d covariance = Vector3d(1e-2, 1e-2, 0).asDiagonal();
  for (const Vector3d& end : confidence_rim(arrow, covariance, 100)) EXPECT_NEAR(end.z(), 0, 1e-12);
}

TEST(UncertaintyGeometry, ArrowIsOnThePlaneInView) {
  const Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.3});
  const NormalArrow arrow = normal_arrow(inspection, plane_grid(inspection, 0.2));
  expect_on(inspection.initialization->plane, std::array{arrow.base});
  EXPECT_GT(inspection.initialization->plane.normal.dot(arrow.tip - arrow.base), 0);
  const OrbitCamera camera = default_scene_camera(inspection, 0.2, 4.0 / 3);
  expect_in_view(camera, std::array{arrow.tip}, {960, 720});
}

TEST(NormalsDisc, CircleHasItsAngleFromTheNormal) {
  const Vector3d normal = Vector3d(0.2, -0.5, -1).normalized();
  for (const Vector2d& disc : circle_on_disc(normal, 7))
    EXPECT_NEAR(angle_deg(normal_from_disc(disc), normal), 7, 1e-6);
}

TEST(NormalsDisc, EllipseHasTheAxesOfTheCovariance) {
  const Vector3d normal = Vector3d(0, -0.6, -0.8);
  const Vector3d a = Vector3d::UnitX(), b = normal.cross(a);
  const Eigen::Matrix3d covariance = 0.0004 * a * a.transpose() + 0.0001 * b * b.transpose();
  double least = 90, most = 0;
  for (const Vector2d& disc : confidence_on_disc(normal, covariance)) {
    const double angle = angle_deg(normal_from_disc(disc), normal);
    least = std::min(least, angle);
    most = std::max(most, angle);
  }
  EXPECT_NEAR(most, degrees(0.02 * std::sqrt(kChiSquare2)), 1e-3);
  EXPECT_NEAR(least, degrees(0.01 * std::sqrt(kChiSquare2)), 1e-3);
}

}  // namespace
}  // namespace gpo
