// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_geometry.h"

#include "engine/inspection/studies/studies.h"
#include "engine/window/tracks.h"
#include "tests/engine/largest.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/image/image_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

const Camera kCamera{
    640, 480, 500, 510, 322, 236, Distortion::radial_tangential, {-.3, .1, .001, -.002, .01}};

Vector2d project_with_opencv(const Camera& camera, const Pose& pose, const Vector3d& point_w) {
  cv::Mat R, rotation, translation, K;
  cv::eigen2cv(Eigen::Matrix3d(pose.R_wc.transpose()), R);
  cv::eigen2cv(to_camera(pose, Vector3d::Zero()), translation);
  cv::eigen2cv(intrinsic_matrix(camera), K);
  cv::Rodrigues(R, rotation);
  const std::vector<cv::Point3d> points_w{{point_w.x(), point_w.y(), point_w.z()}};
  std::vector<cv::Point2d> pixels;
  if (camera.distortion == Distortion::equidistant)
    cv::fisheye::projectPoints(
        points_w, pixels, rotation, translation, K, cv::Mat(camera.coefficients));
  else
    cv::projectPoints(points_w, rotation, translation, K, camera.coefficients, pixels);
  return {pixels[0].x, pixels[0].y};
}

void expect_cube_agrees_with_opencv(const Camera& camera, const Inspection& inspection) {
  const auto corners = cube_corners(*inspection.cube, 0.3);
  for (const Pose& pose : inspection.initialization->cameras) {
    const CubeImage cube = cube_in_image({camera}, pose, corners);
    ASSERT_EQ(cube.edges.size(), 12u);
    for (const CubeEdge& edge : cube.edges) {
      ASSERT_GT(edge.raw_px.size(), 10u);
      const Vector3d &a = corners[edge.corners[0]], &b = corners[edge.corners[1]];
      for (std::size_t i = 0; i < edge.raw_px.size(); ++i) {
        const Vector3d point = a + i / (edge.raw_px.size() - 1.0) * (b - a);
        EXPECT_LT((project_with_opencv(camera, pose, point) - edge.raw_px[i]).norm(), 0.01);
      }
    }
  }
}

TEST(ImageGeometry, CubeAgreesWithOpenCv) {
  Camera fisheye = kCamera;
  fisheye.distortion = Distortion::equidistant;
  fisheye.coefficients = {-0.03, 0.01, -0.004, 0.001};
  for (const Camera& camera : {kCamera, fisheye})
    expect_cube_agrees_with_opencv(camera, made_inspection());
}

const Camera kPinhole{640, 480, 500, 510, 322, 236, Distortion::none, {}};

auto hidden_edges(const CubeImage& cube) {
  return std::ranges::count_if(cube.edges, &CubeEdge::hidden);
}

TEST(ImageGeometry, CubeHidesItsFarEdges) {
  // Straight ahead from above two faces are visible, top and front.
  const Inspection inspection = made_inspection({.distorted = false});
  const CubeImage above =
      cube_in_image({inspection.recording->camera}, Pose(), cube_corners(*inspection.cube, 0.2));
  EXPECT_EQ(hidden_edges(above), 5);
  for (const CubeFace& face : above.faces) EXPECT_FALSE(face.base && face.facing);
  // At its corner, from (4, 3, 2) towards the origin, three are.
  CubeAnchor anchor;
  anchor.axes << 1, 0, 0, 0, -1, 0, 0, 0, 1;
  Pose pose;
  pose.p_wc = Vector3d(4, 3, 2);
  const Vector3d z = -pose.p_wc.normalized(), x = z.cross(Vector3d::UnitZ()).normalized();
  pose.R_wc << x, z.cross(x), z;
  EXPECT_EQ(hidden_edges(cube_in_image({kPinhole}, pose, cube_corners(anchor, 1))), 3);
}

/// A face from behind the camera to 0.5 in front of it, below the optical axis.
TEST(ImageGeometry, FaceThatPassesTheCameraIsCutNotLost) {
  CubeAnchor anchor;
  anchor.origin = Vector3d(0, 0.7, -0.5);
  for (const Camera& camera : {kCamera, kPinhole}) {
    const CubeImage cube = cube_in_image({camera}, Pose(), cube_corners(anchor, 1));
    int drawn = 0;
    for (const CubeFace& face : cube.faces) {
      if (!face.facing || face.raw_px.empty()) continue;
      ++drawn;
      EXPECT_EQ(face.heights.size(), face.raw_px.size());
      double lowest = 0, highest = 1e9;
      for (const Vector2d& pixel : face.raw_px) {
        ASSERT_TRUE(pixel.allFinite());
        lowest = std::max(lowest, pixel.y());
        highest = std::min(highest, pixel.y());
      }
      EXPECT_LT(highest, camera.height - 1) << "its far end is in the image";
      EXPECT_GT(lowest, camera.height - 1) << "it covers the image's lower border";
    }
    EXPECT_EQ(drawn, 1);
  }
}

TEST(ImageGeometry, CubeIsClippedInFrontOfTheCamera) {
  CubeAnchor anchor;
  const auto edges_at = [&](const Vector3d& origin) {
    anchor.origin = origin;
    return cube_in_image({kCamera}, Pose(), cube_corners(anchor, 1)).edges;
  };
  for (const CubeEdge& edge : edges_at({0, 0, -5})) EXPECT_TRUE(edge.raw_px.empty());
  int drawn = 0;
  for (const CubeEdge& edge : edges_at({0, 0.5, -0.5})) {  // from behind to 0.5 in front
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
  EXPECT_TRUE(residual_vectors(made_inspection({.ok = false}), 3).empty());
}

TEST(ImageGeometry, TracksOfAFurtherPlaneHaveTheResidualsOfTheirPlane) {
  Inspection inspection = made_inspection();
  const std::size_t all = residual_vectors(inspection, 12).size();
  Window window = *inspection.window;
  Initialization result = *inspection.initialization;
  window.planes.resize(2);
  for (WindowPlane& plane : window.planes) plane.inlier = window.inlier;
  for (std::vector<bool>& inlier : window.inlier)
    for (std::size_t track = 0; track < inlier.size(); ++track)
      if (track % 3 == 0) inlier[track] = false;
  window.planes[0].inlier = window.inlier;
  for (std::size_t i = 0; i < window.inlier.size(); ++i)
    for (std::size_t track = 0; track < window.inlier[i].size(); ++track)
      if (track % 3 != 0) window.planes[1].inlier[i][track] = false;
  result.planes = {{0, result.plane}, {1, result.plane}};
  // Half as far: parallax by the main plane would be half of that by their own.
  result.planes[1].plane.distance /= 2;
  inspection.window = std::make_shared<const Window>(std::move(window));
  inspection.initialization = std::make_shared<const Initialization>(std::move(result));
  const auto residuals = residual_vectors(inspection, 12);
  EXPECT_EQ(residuals.size(), all);
  for (const ResidualVector& r : residuals) {
    const double px = (r.predicted_px - r.observed_px).norm();
    if (r.track % 3 == 0) {
      EXPECT_GT(px, 3) << r.track;
    } else {
      EXPECT_LT(px, 3) << r.track;
    }
  }
}

TEST(Horizon, IsARowForALevelPinholeAndMovesWithTheCamera) {
  const auto level = horizon_in_image({kPinhole}, Pose{}, -Vector3d::UnitY());
  ASSERT_EQ(level.size(), 1U);
  EXPECT_LT(level[0].front().x(), 15);
  EXPECT_GT(level[0].back().x(), 625);
  for (const Vector2d& pixel : level[0]) EXPECT_NEAR(pixel.y(), kPinhole.cy, 1e-9);
  // Pitch of 10 degrees downwards raises it, roll of 90 degrees makes it vertical.
  const double pitch = 10 * std::numbers::pi / 180;
  Pose down;
  down.R_wc = Eigen::AngleAxisd(-pitch, Vector3d::UnitX()).toRotationMatrix();
  const auto raised = horizon_in_image({kPinhole}, down, -Vector3d::UnitY());
  for (const Vector2d& pixel : raised.at(0))
    EXPECT_NEAR(pixel.y(), kPinhole.cy - kPinhole.fy * std::tan(pitch), 1e-9);
  const auto upright = horizon_in_image({kPinhole}, Pose{}, Vector3d::UnitX());
  for (const Vector2d& pixel : upright.at(0)) EXPECT_NEAR(pixel.x(), kPinhole.cx, 1e-9);
  EXPECT_TRUE(horizon_in_image({kPinhole}, Pose{}, Vector3d::UnitZ()).empty());
}

TEST(Horizon, IsBentByTheLensAsByOpenCv) {
  const Vector3d up = Vector3d(0.1, -1, 0.2).normalized();
  const auto pieces = horizon_in_image({kCamera}, Pose{}, up);
  ASSERT_FALSE(pieces.empty());
  for (const Outline& piece : pieces)
    for (const Vector2d& raw_px : piece) {
      const Vector2d pixel = undistort(kCamera, raw_px);
      const Vector3d ray = intrinsic_matrix(kCamera).inverse() * pixel.homogeneous();
      EXPECT_NEAR(ray.normalized().dot(up), 0, 1e-6);
      EXPECT_LT((project_with_opencv(kCamera, {}, ray) - raw_px).norm(), 1e-4);
    }
}

TEST(ImageMapping, UndistortsAsOpenCvDoes) {
  const ImageMapping mapping{.origin = {10, 20}, .scale = 2, .undistorted = &kCamera};
  for (const Vector3d& ray : {Vector3d(-0.6, 0.45, 1), {0.01, -0.02, 1}, {0.5, 0.4, 1}}) {
    const Vector2d raw_px = project_with_opencv(kCamera, {}, ray);
    const Vector2d pinhole_px = (intrinsic_matrix(kCamera) * ray).hnormalized();
    const Vector2d on_screen = Vector2d(10, 20) + 2 * (pinhole_px + Vector2d(0.5, 0.5));
    EXPECT_LT((to_screen(mapping, raw_px) - on_screen).norm(), 1e-6);
    EXPECT_LT((to_image(mapping, on_screen) - raw_px).norm(), 1e-6);
  }
}

TEST(TowerInImage, HasTheCubesBase) {
  const Inspection inspection = made_inspection();
  const auto cube = cube_corners(*inspection.cube, 0.3);
  const auto tower = cube_corners(*inspection.cube, 0.3, 5);
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(tower[k], cube[k]);
    EXPECT_LT((tower[k + 4] - tower[k] - 5 * (cube[k + 4] - cube[k])).norm(), 1e-12);
  }
  const auto base_px = [&](double height) {
    return estimated_cube(inspection, 20, {0.3, height})->edges.front().raw_px;
  };
  EXPECT_EQ(base_px(1), base_px(5));
}

TEST(ExaggeratedCube, MultipliesTheDistanceFromItsReference) {
  const Inspection inspection = made_inspection({.estimate_error = 0.1});
  const auto cube = estimated_cube(inspection, 20, {0.3});
  const auto truth = true_cube(inspection, 20, {0.3});
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

TEST(ContactShadow, IsOnThePlaneAroundTheCubesBase) {
  const Inspection inspection = made_inspection();
  const double side = 0.3;
  const auto rings = contact_shadow(inspection, 20, *inspection.cube, side);
  ASSERT_FALSE(rings.empty());
  double farther = 1e9;
  for (const Outline& ring : rings) {
    double farthest = 0;
    for (const Vector2d& pixel : ring) {
      const auto point = point_on_plane(inspection, 20, pixel, inspection.initialization->plane);
      ASSERT_TRUE(point.has_value());
      const Vector3d from = inspection.cube->axes.transpose() * (*point - inspection.cube->origin);
      EXPECT_LT(std::abs(from.z()), 1e-4);
      const double reach = test::largest(from.head<2>());
      EXPECT_GE(reach, side / 2 - 1e-4) << "outside of the base";
      farthest = std::max(farthest, reach);
    }
    EXPECT_LT(farthest, farther);
    farther = farthest;
  }
}

CubeCorners cube_of(const Inspection& inspection) {
  return cube_corners(*inspection.cube, cube_side(inspection, 0));
}

/// Adds a plane across the reference camera's view, `times_as_far` as the cube. Its inliers are the
/// tracks with `on_it(track, cube)`, of their places in the image [px].
template <class OnIt>
Inspection with_plane_across(double times_as_far, OnIt&& on_it) {
  Inspection inspection = made_inspection();
  const CubeCorners corners = cube_of(inspection);
  const Vector3d middle = (corners[0] + corners[7]) / 2;
  const Vector2d cube_px = (inspection.window->K * middle).hnormalized();
  auto window = std::make_shared<Window>(*inspection.window);
  window->planes.resize(2);
  std::vector<bool> agrees(window->track_count());
  for (int j = 0; j < window->track_count(); ++j) {
    agrees[j] = on_it(Vector2d(window->points_px[0].col(j)), cube_px);
    if (agrees[j]) window->planes[1].tracks.push_back(j);
  }
  window->planes[1].inlier.assign(window->frame_count(), agrees);
  for (auto& inlier : window->inlier)
    for (const int j : window->planes[1].tracks) inlier[j] = false;
  window->planes[0].inlier = window->inlier;
  auto initialization = std::make_shared<Initialization>(*inspection.initialization);
  initialization->planes.resize(2);
  initialization->planes[1].number = 1;
  initialization->planes[1].plane = {-Vector3d::UnitZ(), times_as_far * middle.z()};
  inspection.window = window;
  inspection.initialization = initialization;
  return inspection;
}

bool around(const Vector2d& track, const Vector2d& cube) { return (track - cube).norm() < 150; }

TEST(Occluders, AreNearerPlanesBetweenTheirTracks) {
  const Inspection nearer = with_plane_across(0.5, around);
  const auto found = occluders(nearer, 0, cube_of(nearer));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].plane, 1);
  ASSERT_FALSE(found[0].triangles_raw_px.empty());
  const auto& all_px = nearer.tracks->raw_px[0];
  const double longest = 0.15 * nearer.recording->camera.width + 1e-3;
  for (const auto& triangle : found[0].triangles_raw_px)
    for (int k = 0; k < 3; ++k) {
      const auto is_corner = [&](int j) { return (all_px.col(j) - triangle[k]).norm() < 1e-3; };
      EXPECT_TRUE(std::ranges::any_of(nearer.window->planes[1].tracks, is_corner));
      EXPECT_LE((triangle[k] - triangle[(k + 1) % 3]).norm(), longest);
    }
}

TEST(Occluders, LeaveOutTrianglesWithOtherTracks) {
  int count = 0;
  const auto with_gaps = [&count](const Vector2d& track, const Vector2d& cube) {
    return around(track, cube) && count++ % 3 != 0;
  };
  const Inspection gaps = with_plane_across(0.5, with_gaps);
  const auto found = occluders(gaps, 0, cube_of(gaps));
  ASSERT_EQ(found.size(), 1U);
  for (int track = 0; track < gaps.tracks->track_count(); ++track) {
    if (gaps.window->planes[1].inlier[0][track] || !gaps.tracks->seen(0, track)) continue;
    for (const auto& [a, b, c] : found[0].triangles_raw_px) {
      Eigen::Matrix2d sides;
      sides << b - a, c - a;
      const Vector2d weights = sides.inverse() * (gaps.tracks->raw_px[0].col(track) - a);
      ASSERT_TRUE(weights.allFinite());
      EXPECT_FALSE(weights.minCoeff() > 1e-3 && weights.sum() < 1 - 1e-3) << track;
    }
  }
}

TEST(Occluders, AreNotPlanesBehindBesideOrThroughTheCube) {
  for (const double times_as_far : {3.0, 1.0}) {
    const Inspection inspection = with_plane_across(times_as_far, around);
    EXPECT_TRUE(occluders(inspection, 0, cube_of(inspection)).empty()) << times_as_far;
  }
  const Inspection beside = with_plane_across(
      0.5, [](const Vector2d& track, const Vector2d& cube) { return track.x() < cube.x() - 120; });
  ASSERT_GE(beside.window->planes[1].tracks.size(), 3U);
  EXPECT_TRUE(occluders(beside, 0, cube_of(beside)).empty());
  const Inspection alone = made_inspection();
  EXPECT_TRUE(occluders(alone, 0, cube_of(alone)).empty());
}

}  // namespace
}  // namespace gpo
