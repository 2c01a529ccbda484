// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_geometry.h"

#include "tests/ui/made_inspection.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Camera kCamera{
    640, 480, 500, 510, 322, 236, Distortion::radial_tangential, {-.3, .1, .001, -.002, .01}};

/// OpenCV's own projection, raw pixels.
std::vector<Vector2d> project_with_opencv(const Camera& camera,
                                          const Pose& pose,
                                          const std::vector<Vector3d>& points_w) {
  cv::Mat R, rotation, translation, K;
  const Eigen::Matrix3d R_cw = pose.R_wc.transpose();
  const Vector3d t_cw = -R_cw * pose.p_wc;
  cv::eigen2cv(R_cw, R);
  cv::eigen2cv(t_cw, translation);
  cv::eigen2cv(intrinsic_matrix(camera), K);
  cv::Rodrigues(R, rotation);
  std::vector<cv::Point3d> points;
  for (const Vector3d& p : points_w) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<cv::Point2d> pixels;
  if (camera.distortion == Distortion::equidistant) {
    cv::fisheye::projectPoints(
        points, pixels, rotation, translation, K, cv::Mat(camera.coefficients));
  } else {
    cv::projectPoints(points, rotation, translation, K, camera.coefficients, pixels);
  }
  std::vector<Vector2d> result;
  for (const cv::Point2d& pixel : pixels) result.emplace_back(pixel.x, pixel.y);
  return result;
}

void expect_cube_agrees_with_opencv(const Camera& camera) {
  const Inspection inspection = made_inspection();
  const auto corners = cube_corners(*inspection.cube, 0.3);
  for (const Pose& pose : inspection.initialization->cameras) {
    const CubeImage cube = cube_in_image(camera, pose, corners);
    ASSERT_EQ(cube.edges.size(), 12u);
    for (const CubeEdge& edge : cube.edges) {
      ASSERT_GT(edge.raw_px.size(), 10u);
      // Ends and every point between.
      std::vector<Vector3d> points;
      const auto last = static_cast<double>(edge.raw_px.size() - 1);
      for (std::size_t i = 0; i < edge.raw_px.size(); ++i)
        points.push_back(corners[edge.corners[0]] +
                         i / last * (corners[edge.corners[1]] - corners[edge.corners[0]]));
      const auto expected = project_with_opencv(camera, pose, points);
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((edge.raw_px[i] - expected[i]).norm(), 0.01);
    }
  }
}

TEST(ImageGeometry, CubeAgreesWithOpenCvThroughBrownsLens) {
  expect_cube_agrees_with_opencv(kCamera);
}

TEST(ImageGeometry, CubeAgreesWithOpenCvThroughAFisheye) {
  Camera camera = kCamera;
  camera.distortion = Distortion::equidistant;
  camera.coefficients = {-0.03, 0.01, -0.004, 0.001};
  expect_cube_agrees_with_opencv(camera);
}

TEST(ImageGeometry, CubeSeenFromAboveHidesItsFarEdges) {
  // Straight ahead and from above: the base's far edge and the two edges that rise from its ends.
  const Inspection inspection = made_inspection({.distorted = false});
  const CubeImage cube =
      cube_in_image(inspection.recording->camera, Pose(), cube_corners(*inspection.cube, 0.2));
  int hidden = 0;
  for (const CubeEdge& edge : cube.edges) hidden += edge.hidden;
  EXPECT_EQ(hidden, 5);  // two faces are seen: top and front
  for (const CubeFace& face : cube.faces) EXPECT_FALSE(face.base && face.facing);
}

TEST(ImageGeometry, CubeSeenAtItsCornerHidesThreeEdges) {
  CubeAnchor anchor;
  anchor.axes << 1, 0, 0, 0, -1, 0, 0, 0, 1;
  Pose pose;  // from (4, 3, 2), looking at the origin
  pose.p_wc = Vector3d(4, 3, 2);
  const Vector3d z = -pose.p_wc.normalized(), x = z.cross(Vector3d::UnitZ()).normalized();
  pose.R_wc << x, z.cross(x), z;
  Camera camera = kCamera;
  camera.distortion = Distortion::none;
  const CubeImage cube = cube_in_image(camera, pose, cube_corners(anchor, 1));
  int hidden = 0;
  for (const CubeEdge& edge : cube.edges) hidden += edge.hidden;
  EXPECT_EQ(hidden, 3);
}

TEST(ImageGeometry, CubeBehindTheCameraIsNotDrawnAndOneBesideItIsCutOff) {
  CubeAnchor anchor;
  anchor.origin = Vector3d(0, 0, -5);
  for (const CubeEdge& edge : cube_in_image(kCamera, Pose(), cube_corners(anchor, 1)).edges)
    EXPECT_TRUE(edge.raw_px.empty());
  anchor.origin = Vector3d(0, 0.5, -0.5);  // reaches from behind to 0.5 in front
  int drawn = 0;
  for (const CubeEdge& edge : cube_in_image(kCamera, Pose(), cube_corners(anchor, 1)).edges) {
    drawn += !edge.raw_px.empty();
    for (const Vector2d& pixel : edge.raw_px) EXPECT_TRUE(pixel.allFinite());
  }
  EXPECT_GT(drawn, 0);
  EXPECT_LT(drawn, 12);
}

TEST(ImageGeometry, ResidualsOfATrueEstimateAreTheNoiseOfTheTracks) {
  const Inspection inspection = made_inspection();
  for (const int frame : {1, 12, 29}) {
    const auto residuals = residual_vectors(inspection, frame);
    ASSERT_GT(residuals.size(), 50u);
    double sum = 0;
    for (const ResidualVector& r : residuals) sum += (r.predicted_px - r.observed_px).squaredNorm();
    // Two coordinates, noise 0.4 px in this frame and in the reference frame.
    EXPECT_NEAR(std::sqrt(sum / (2.0 * residuals.size())), 0.4 * std::sqrt(2), 0.15);
  }
}

TEST(ImageGeometry, ResidualsOfAFailedInitializationAreNone) {
  EXPECT_TRUE(residual_vectors(made_inspection({.ok = false}), 3).empty());
}

TEST(Horizon, OfALevelPinholeIsARowAndTurnsWithTheCamera) {
  Camera pinhole = kCamera;
  pinhole.distortion = Distortion::none;
  pinhole.coefficients = {};
  const auto level = horizon_in_image(pinhole, Pose{}, -Vector3d::UnitY());
  ASSERT_EQ(level.size(), 1U);
  EXPECT_LT(level[0].front().x(), 15);
  EXPECT_GT(level[0].back().x(), 625);
  for (const Vector2d& pixel : level[0]) EXPECT_NEAR(pixel.y(), pinhole.cy, 1e-9);
  // Looking down by 10 degrees raises it, rolled by 90 it stands.
  Pose down;
  down.R_wc = Eigen::AngleAxisd(-10 * std::numbers::pi / 180, Vector3d::UnitX()).toRotationMatrix();
  const auto raised = horizon_in_image(pinhole, down, -Vector3d::UnitY());
  for (const Vector2d& pixel : raised.at(0))
    EXPECT_NEAR(pixel.y(), pinhole.cy - pinhole.fy * std::tan(10 * std::numbers::pi / 180), 1e-9);
  const auto upright = horizon_in_image(pinhole, Pose{}, Vector3d::UnitX());
  for (const Vector2d& pixel : upright.at(0)) EXPECT_NEAR(pixel.x(), pinhole.cx, 1e-9);
  EXPECT_TRUE(horizon_in_image(pinhole, Pose{}, Vector3d::UnitZ()).empty());
}

TEST(Horizon, BendsThroughTheLensAsOpenCvSays) {
  const Vector3d up = Vector3d(0.1, -1, 0.2).normalized();
  const auto pieces = horizon_in_image(kCamera, Pose{}, up);
  ASSERT_FALSE(pieces.empty());
  for (const auto& piece : pieces)
    for (const Vector2d& raw_px : piece) {
      const Vector2d pixel = undistort(kCamera, raw_px);
      const Vector3d ray = intrinsic_matrix(kCamera).inverse() * pixel.homogeneous();
      EXPECT_NEAR(ray.normalized().dot(up), 0, 1e-6);
      const auto again = project_with_opencv(kCamera, Pose{}, {ray});
      EXPECT_LT((again[0] - raw_px).norm(), 1e-4);
    }
}

TEST(TowerInImage, StandsOnTheCubesBase) {
  const Inspection inspection = made_inspection();
  const auto cube = cube_corners(*inspection.cube, 0.3);
  const auto tower = cube_corners(*inspection.cube, 0.3, 5);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(tower[k], cube[k]);
    EXPECT_LT((tower[k + 4] - tower[k] - 5 * (cube[k + 4] - cube[k])).norm(), 1e-12);
  }
  const auto base_px = [&](double height) {
    return estimated_cube(inspection, 20, 0.3, height)->edges.front().raw_px;
  };
  EXPECT_EQ(base_px(1), base_px(5));
}

TEST(ExaggeratedCube, IsSoManyTimesAsFarFromItsReference) {
  const Inspection inspection = made_inspection({.estimate_error = 0.1});
  const auto cube = estimated_cube(inspection, 20, 0.3);
  const auto truth = true_cube(inspection, 20, 0.3);
  ASSERT_TRUE(cube && truth);
  const CubeImage far = exaggerated(*cube, *truth, 20);
  ASSERT_EQ(far.edges.size(), 12U);
  double largest = 0;
  for (std::size_t i = 0; i < far.edges.size(); ++i) {
    ASSERT_EQ(far.edges[i].raw_px.size(), cube->edges[i].raw_px.size());
    for (std::size_t k = 0; k < far.edges[i].raw_px.size(); ++k) {
      const Vector2d from = truth->edges[i].raw_px[k];
      const Vector2d there = far.edges[i].raw_px[k] - from;
      EXPECT_LT((there - 20 * (cube->edges[i].raw_px[k] - from)).norm(), 1e-9);
      largest = std::max(largest, there.norm());
    }
  }
  EXPECT_GT(largest, 1) << "the cubes differ";
  EXPECT_EQ(exaggerated(*cube, *truth, 1).edges[3].raw_px[5], cube->edges[3].raw_px[5]);
  CubeImage cut = *truth;
  cut.edges[0].raw_px.pop_back();
  EXPECT_TRUE(exaggerated(*cube, cut, 20).edges[0].raw_px.empty());
}

TEST(ContactShadow, LiesOnThePlaneAroundTheCubesBase) {
  const Inspection inspection = made_inspection();
  const double side = 0.3;
  const auto rings = contact_shadow(inspection, 20, side);
  ASSERT_FALSE(rings.empty());
  double farther = 1e9;
  for (const auto& ring : rings) {
    double farthest = 0;
    for (const Vector2d& pixel : ring) {
      const auto point = point_on_plane(inspection, 20, pixel, inspection.initialization->plane);
      ASSERT_TRUE(point.has_value());
      const Vector3d from = *point - inspection.cube->origin;
      EXPECT_LT(std::abs(from.dot(inspection.cube->axes.col(2))), 1e-4);
      const double x = std::abs(from.dot(inspection.cube->axes.col(0)));
      const double y = std::abs(from.dot(inspection.cube->axes.col(1)));
      EXPECT_GE(std::max(x, y), side / 2 - 1e-4) << "outside of the base";
      farthest = std::max({farthest, x, y});
    }
    EXPECT_LT(farthest, farther);
    farther = farthest;
  }
  EXPECT_TRUE(contact_shadow(made_inspection({.ok = false}), 20, side).empty());
}

}  // namespace
}  // namespace gpo
