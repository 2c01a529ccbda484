// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspection.h"
#include "engine/inspection/inspector.h"
#include "engine/inspection/report/report.h"
#include "engine/inspection/studies/studies.h"
#include "tests/engine/desk.h"
#include "tests/engine/test_folder.h"

#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using Eigen::Vector2d, Eigen::Vector3d, testing::HasSubstr;

const Camera kMeasuringCamera{640, 480, 500, 500, 319.5, 239.5, Distortion::none, {}};
const Plane kFloor{Vector3d(0, -0.6, -0.8), 1};
const Plane kWall{Vector3d(-0.8, 0, -0.6), 1.5};
constexpr int kRoomStart = 10;
constexpr double kMetersPerUnit = 0.4;

/// A room without errors: a floor in the left half of the reference image and a wall in the right
/// half, in two frames. The upper quarter has no tracks.
struct MeasuredRoom : testing::Test {
  MeasuredRoom() {
    const Pose second{so3_exp({0.02, -0.05, 0.01}), {0.2, 0.05, 0.1}};
    auto recording = std::make_shared<Recording>();
    auto tracks = std::make_shared<Tracks>();
    auto window = std::make_shared<Window>();
    auto result = std::make_shared<Initialization>();
    recording->camera = kMeasuringCamera;
    recording->timestamps_ns = std::vector<std::int64_t>(20, 0);
    result->ok = true;
    result->plane = kFloor;
    result->cameras = {Pose{}, second};
    result->planes = {{.number = 0, .plane = kFloor}, {.number = 1, .plane = kWall}};
    std::vector<Vector2d> pixels;
    for (int y = 120; y < 480; y += 20)
      for (int x = 10; x < 640; x += 20) pixels.emplace_back(x, y);
    const auto count = std::ssize(pixels);
    window->start = tracks->start = kRoomStart;
    window->K = intrinsic_matrix(kMeasuringCamera);
    window->timestamps_ns = {0, 1};
    window->planes.resize(2);
    window->points_px.assign(2, Eigen::Matrix2Xd(2, count));
    window->inlier.assign(2, std::vector<bool>(count));
    for (WindowPlane& plane : window->planes) plane.inlier = window->inlier;
    for (int j = 0; j < count; ++j) {
      const int k = pixels[j].x() < 320 ? 0 : 1;
      const Vector3d point = on_plane(pixels[j], k == 0 ? kFloor : kWall);
      window->points_px[0].col(j) = pixels[j];
      window->points_px[1].col(j) = project(kMeasuringCamera, to_camera(second, point));
      window->planes[k].tracks.push_back(j);
      for (int i = 0; i < 2; ++i) window->planes[k].inlier[i][j] = true;
      tracks->ids.push_back(j);
    }
    window->inlier = window->planes[0].inlier;
    tracks->raw_px = window->points_px;
    room_.recording = recording;
    room_.tracks = tracks;
    room_.window = window;
    room_.initialization = result;
    room_.settings.start = kRoomStart;
  }
  static Vector3d on_plane(const Vector2d& pixel, const Plane& plane) {
    const Vector3d ray((pixel.x() - 319.5) / 500, (pixel.y() - 239.5) / 500, 1);
    return ray * (-plane.distance / plane.normal.dot(ray));
  }
  void measure(const std::string& points, const std::string& length) {
    room_.settings = with_setting(room_.settings, "scale_points", points);
    room_.settings = with_setting(room_.settings, "scale_length", length);
    room_.measured_scale = measure_scale(room_);
  }
  void choose(const std::string& points, const std::string& up = "plane") {
    room_.settings = with_setting(room_.settings, "world_points", points);
    room_.settings = with_setting(room_.settings, "world_up", up);
    room_.chosen_world = choose_world(room_);
  }

  Inspection room_;
};

TEST_F(MeasuredRoom, ScaleIsExactForPointsOnOneAndOnTwoPlanesInAnyFrame) {
  const Vector3d a = on_plane({100, 400}, kFloor), b = on_plane({250, 200}, kFloor);
  const Vector3d c = on_plane({500, 300}, kWall);
  const auto text = [](double meters) { return fmt::format("{}", kMetersPerUnit * meters); };
  measure("100,400,250,200", text((a - b).norm()));
  EXPECT_NEAR(*known_scale(room_), kMetersPerUnit, 1e-9);
  measure("100,400,500,300,10", text((a - c).norm()));
  EXPECT_NEAR(*known_scale(room_), kMetersPerUnit, 1e-9);
  const Pose& second = room_.initialization->cameras[1];
  const Vector2d p = project(kMeasuringCamera, to_camera(second, a));
  const Vector2d q = project(kMeasuringCamera, to_camera(second, c));
  measure(fmt::format("{},{},{},{},11", p.x(), p.y(), q.x(), q.y()), text((a - c).norm()));
  EXPECT_NEAR(*known_scale(room_), kMetersPerUnit, 1e-9);
  EXPECT_FALSE(room_.measured_scale->log_sigma) << "the result has no uncertainty";
}

TEST_F(MeasuredRoom, SigmaIsTheSpreadOfTheScaleUnderErrorsOfPointsAndPlane) {
  Initialization result = *room_.initialization;
  const Eigen::Matrix<double, 3, 2> tangents = normal_tangents(kFloor.normal);
  result.uncertainty.emplace().normal_covariance = 1e-4 * tangents * tangents.transpose();
  result.uncertainty->normal_sigma_deg = degrees(std::sqrt(2e-4));
  room_.initialization = std::make_shared<const Initialization>(result);
  measure("100,400,250,200", "0.5");
  const double sigma = *room_.measured_scale->log_sigma;
  room_.settings.scale_length_sigma = 0.05;
  EXPECT_NEAR(*measure_scale(room_)->log_sigma, std::hypot(sigma, 0.1), 1e-9);
  room_.settings.scale_length_sigma = 0;
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const double expected = std::log(room_.measured_scale->meters_per_unit);
  double squares = 0;
  constexpr int kTrials = 2000;
  for (int i = 0; i < kTrials; ++i) {
    Plane floor = kFloor;
    const double x = normal(random), y = normal(random);
    floor.normal = (floor.normal + 0.01 * tangents * Vector2d(x, y)).normalized();
    std::array<Vector2d, 2> pixels{Vector2d(100, 400), Vector2d(250, 200)};
    for (Vector2d& pixel : pixels) {
      pixel.x() += 0.5 * normal(random);
      pixel.y() += 0.5 * normal(random);
    }
    const double length = (on_plane(pixels[0], floor) - on_plane(pixels[1], floor)).norm();
    squares += std::pow(std::log(0.5 / length) - expected, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials) / sigma, 1, 0.08);
}

TEST_F(MeasuredRoom, ErrorsNameThePointAndTheReason) {
  const auto refusal = [&](const std::string& points) {
    measure(points, "1");
    EXPECT_THROW(check_chosen(room_), InputError);
    EXPECT_THROW(meters_per_unit(room_), InputError);
    EXPECT_FALSE(known_scale(room_));
    room_.findings.clear();
    add_findings(room_);
    EXPECT_THAT(notes_of(room_), testing::Contains(room_.measured_scale->reason));
    return room_.measured_scale->reason;
  };
  EXPECT_EQ(refusal("100,40,250,200"),
            "scale_points: point (100, 40) is on no plane: none of a plane's tracks is within 32 "
            "px");
  EXPECT_EQ(refusal("100,400,700,200"), "scale_points: point (700, 200) is outside of the image");
  EXPECT_EQ(refusal("100,400,250,200,12"),
            "scale_points: frame 12 of the points is outside of the window 10-11");
  EXPECT_EQ(refusal("none"), "scale_points: scale_length needs scale_points");
  const auto invalid = [](const char* key, const char* text) {
    return error_of([&] { with_setting({}, key, text); });
  };
  EXPECT_EQ(invalid("scale_points", "1,2,1,2"),
            "scale_points: '1,2,1,2', expected two different points");
  EXPECT_THAT(invalid("scale_points", "1,2,3"), HasSubstr("expected X1,Y1,X2,Y2"));
  EXPECT_THAT(invalid("scale_points", "1,2,3,4,5.5"), HasSubstr("expected X1,Y1,X2,Y2"));
  EXPECT_THAT(invalid("scale_length", "0"), HasSubstr("scale_length: '0', expected a number"));
  EXPECT_THAT(invalid("scale_length", "-1"), HasSubstr("scale_length: '-1', expected a number"));
  choose("100,400,250,200", "gravity");
  EXPECT_EQ(room_.chosen_world->reason,
            "world_points: gravity is unknown (no accelerometer is used)");
}

TEST_F(MeasuredRoom, WorldHasItsOriginAndXAxisOnTheFloorAndZTowardsTheCamera) {
  const Vector3d a = on_plane({100, 400}, kFloor), b = on_plane({250, 200}, kFloor);
  choose("100,400,250,200");
  const ExportWorld in_units = export_world(room_, false);
  EXPECT_LT((in_units.T_world_reference * a).norm(), 1e-9);
  const Vector3d along = in_units.T_world_reference * b;
  EXPECT_LT((along - Vector3d((a - b).norm(), 0, 0)).norm(), 1e-9);
  EXPECT_NEAR((in_units.T_world_reference * Vector3d::Zero()).z(), 1, 1e-9)
      << "the camera's height";
  EXPECT_NEAR(in_units.T_world_reference.R_ab.determinant(), 1, 1e-9);
  measure("100,400,250,200", fmt::format("{}", kMetersPerUnit * (a - b).norm()));
  const CameraPath path = estimated_path(room_, export_world(room_, false));
  EXPECT_THAT(path.world, HasSubstr("unit = meter")) << "the length is in meters";
  EXPECT_NEAR(path.cameras[0].p_wc.z(), kMetersPerUnit, 1e-9);
  const Vector3d moved = path.cameras[1].p_wc - path.cameras[0].p_wc;
  EXPECT_NEAR(moved.norm(), kMetersPerUnit * room_.initialization->cameras[1].p_wc.norm(), 1e-9);
}

TEST_F(MeasuredRoom, WorldIsUprightByGravity) {
  const Vector3d up = Vector3d(0.1, -0.9, -0.3).normalized();
  room_.inertial.emplace();
  room_.inertial->ok = true;
  room_.inertial->gravity_m_s2 = -9.81 * up;
  choose("100,400,500,300", "gravity");
  const Similarity T = export_world(room_, false).T_world_reference;
  EXPECT_LT((T.R_ab * up - Vector3d::UnitZ()).norm(), 1e-9);
  const Vector3d towards = T * on_plane({500, 300}, kWall);
  EXPECT_NEAR(towards.y(), 0, 1e-9);
  EXPECT_GT(towards.x(), 0);
}

TEST_F(MeasuredRoom, EachPlaneHasItsCubeAndAnotherPlanesCubeMovesAlone) {
  room_.cube = anchor_on_plane(kFloor, Pose{}, {0, 0.2, 1});
  room_.other_cubes = place_other_cubes(room_);
  ASSERT_EQ(room_.other_cubes.size(), 1U);
  EXPECT_EQ(room_.other_cubes[0].plane, 1);
  const CubeAnchor main = *room_.cube;
  move_cubes(room_, {0.3, 0.1, 1}, 1);
  EXPECT_EQ(*room_.cube, main);
  const auto corners = cube_corners(room_.other_cubes[0], 0.2);
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(kWall.normal.dot(corners[k]) + kWall.distance, 0, 1e-9);
  EXPECT_LT(angle_deg(room_.other_cubes[0].origin, {0.3, 0.1, 1}), 1e-6);
  EXPECT_EQ(all_cubes(room_).size(), 2U);
}

TEST(MeasuredDesk, ScaleAgreesWithTruthWithinFourSigmas) {
  Settings settings;
  settings = with_setting(settings, "scale_points", "137,231,432,334");
  settings = with_setting(settings, "scale_length", "1");
  Inspector inspector(desk());
  const auto first = inspector.inspect(settings);
  ASSERT_TRUE(first->measured_scale && first->measured_scale->reason.empty())
      << first->measured_scale->reason;
  const WindowTruth& truth = *first->truth;
  const auto place = [&](const Vector2d& pixel) {
    const Camera& camera = first->recording->camera;
    const Vector3d ray =
        intrinsic_matrix(camera).inverse() * undistort(camera, pixel).homogeneous();
    return *intersect(*truth.plane, *truth.cameras[0], ray);
  };
  const double length = (place({137, 231}) - place({432, 334})).norm();
  settings = with_setting(settings, "scale_length", fmt::format("{}", length));
  const auto inspection = inspector.inspect(settings);
  const MeasuredScale& scale = *inspection->measured_scale;
  EXPECT_LT(std::abs(*inspection->evaluation->scale_error_percent), 400 * *scale.log_sigma + 0.5);
  EXPECT_LT(*scale.log_sigma, 0.02);
  const auto json = to_json(*inspection);
  EXPECT_EQ(json["metric_scale"]["source"], "points");
  EXPECT_EQ(json["metric_scale"]["meters_per_unit"], scale.meters_per_unit);
  EXPECT_EQ(json["settings"]["scale_points"], (std::vector<double>{137, 231, 432, 334}));
  EXPECT_THAT(to_text(*inspection), HasSubstr("by two points; the plane is "));
}

}  // namespace
}  // namespace gpo::test
