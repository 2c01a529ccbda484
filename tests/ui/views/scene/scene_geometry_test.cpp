// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "engine/methods/plane/normal_landscape.h"
#include "engine/truth/truth.h"
#include "tests/engine/test_folder.h"
#include "tests/ui/made_inspection.h"
#include "ui/views/model/solid_model.h"
#include "ui/views/scene/scene_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d, testing::HasSubstr;

template <class Points>
void expect_in_view(const OrbitCamera& camera, const Points& points, const Vector2d& size) {
  for (const Vector3d& point : points) {
    const Vector2d pixel = on_screen(camera, point, {{0, 0}, size}).value();
    EXPECT_TRUE((pixel.array() > 0 && pixel.array() < size.array()).all());
  }
}

template <class Points>
void expect_on(const Plane& plane, const Points& points) {
  for (const Vector3d& point : points)
    EXPECT_NEAR(plane.normal.dot(point) + plane.distance, 0, 1e-9);
}

void expect_truth_on_the_estimate(const Inspection& inspection) {
  const std::map<int, Pose> cameras = true_cameras(inspection);
  for (int i = 0; i < inspection.window->frame_count(); ++i) {
    const Pose pose = cameras.at(i);
    EXPECT_LT((pose.p_wc - inspection.initialization->cameras[i].p_wc).norm(), 1e-9);
    EXPECT_LT((pose.R_wc - inspection.initialization->cameras[i].R_wc).norm(), 1e-9);
  }
}

class SceneGeometry : public testing::Test {
 protected:
  Inspection inspection = made_inspection();
  Plane plane = inspection.initialization->plane;
};

TEST_F(SceneGeometry, TruthAgreesWithAPerfectEstimate) {
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

TEST_F(SceneGeometry, TruthWithoutScaleIsUnknown) {
  auto truth = std::make_shared<WindowTruth>(*inspection.truth);
  truth->plane.reset();
  inspection.truth = truth;
  inspection.evaluation.reset();
  EXPECT_FALSE(estimate_from_truth(inspection));
  EXPECT_FALSE(estimate_from_truth(made_inspection({.truth = false})));
}

TEST_F(SceneGeometry, TruePlanesBorderIsOnAPerfectEstimate) {
  const PlaneGrid grid = plane_grid(inspection, 0.2);
  const auto border = true_plane_border(inspection, grid);
  expect_on(plane, border.value());
}

TEST_F(SceneGeometry, GridIsOnThePlaneAndContainsTheCube) {
  inspection = made_inspection({.estimate_error = 4});
  plane = inspection.initialization->plane;
  const PlaneGrid grid = plane_grid(inspection, 0.2);
  EXPECT_NEAR(plane.normal.dot(grid.at(3, -2)) + plane.distance, 0, 1e-12);
  EXPECT_NEAR(grid.x.dot(grid.y), 0, 1e-12);
  for (const Vector3d& corner : cube_corners(*inspection.cube, 0.2)) {
    const double i = grid.x.dot(corner - grid.origin) / grid.cell;
    const double j = grid.y.dot(corner - grid.origin) / grid.cell;
    EXPECT_TRUE(i > grid.low[0] && i < grid.high[0] && j > grid.low[1] && j < grid.high[1]);
  }
}

TEST_F(SceneGeometry, CellsAreNiceLengthsOfAMeasuredScale) {
  inspection.measured_scale = MeasuredScale{.meters_per_unit = 0.7123};
  const double cell_m = 0.7123 * plane_grid(inspection, 0.2).cell;
  EXPECT_NEAR(nice_length(cell_m), cell_m, 1e-9) << "though the truth has another scale";
}

TEST_F(SceneGeometry, FrustumHasTheImagesCorners) {
  const Camera camera{640, 480, 500, 505, 322, 236, Distortion::none, {}};
  const auto corners = frustum(camera, Pose(), 0.3);
  EXPECT_LT((project(camera, corners[1]) - Vector2d(-0.5, -0.5)).norm(), 1e-9);
  EXPECT_LT((project(camera, corners[3]) - Vector2d(639.5, 479.5)).norm(), 1e-9);
  EXPECT_NEAR(corners[2].z(), 0.3, 1e-12);
  EXPECT_LT(project(camera, corners[5]).y(), -1) << "the mark is above the image";
}

TEST_F(SceneGeometry, DefaultViewShowsTheWholeSceneFromAbove) {
  const MadeOptions kinds[] = {{}, {.truth = false}, {.ok = false}, {.refused = true}};
  for (const MadeOptions& made : kinds) {
    const Inspection shown = made_inspection(made);
    const OrbitCamera camera = default_scene_camera(shown, 0.2, 4.0 / 3);
    expect_in_view(camera, scene_extent(shown, 0.2), {960, 720});
  }
  const Vector3d at = eye(default_scene_camera(inspection, 0.2, 1));
  EXPECT_GT(plane.normal.dot(at) + plane.distance, 0);
}

TEST_F(SceneGeometry, ShowsARejectedSolution) {
  const Inspection refused = made_inspection({.refused = true});
  EXPECT_FALSE(refused.initialization->ok);
  const auto& cameras = found_cameras(*refused.initialization);
  ASSERT_EQ(cameras.size(), inspection.initialization->cameras.size());
  EXPECT_EQ(cameras.back().p_wc, inspection.initialization->cameras.back().p_wc);
  expect_on(plane, refused_patches(refused).at(0).corners);
  EXPECT_TRUE(found_cameras(*made_inspection({.ok = false}).initialization).empty());
  EXPECT_TRUE(refused_patches(made_inspection({.ok = false})).empty());
}

TEST_F(SceneGeometry, ViewpointsHaveTheirDirectionsAndShowTheWholeScene) {
  const Vector3d& up = plane.normal;
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

TEST_F(SceneGeometry, ViewThroughACameraIsItsImage) {
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
    const Vector2d seen = *on_screen(camera, point.position, {{0, 0}, size});
    EXPECT_LT((seen - pinhole).norm(), 0.03 * (pinhole - size / 2).norm() + 1e-6);
  }
}

TEST_F(SceneGeometry, ViewThroughACameraIsTurnedLikeItsImage) {
  const int start = inspection.window->start;
  auto recording = std::make_shared<Recording>(*inspection.recording);
  recording->camera.cx = (recording->camera.width - 1) / 2.0;
  recording->camera.cy = (recording->camera.height - 1) / 2.0;
  recording->camera.fy = recording->camera.fx;
  inspection.recording = recording;
  for (int turns = 0; turns < 4; ++turns) {
    recording->quarter_turns = turns;
    const ShownImage image(recording->camera, turns);
    const Vector2d size = image.size();
    const OrbitCamera camera =
        scene_camera(inspection, 0.2, size.x() / size.y(), Viewpoint::camera, start + 3);
    const ImageMapping mapping = map_image(image, {{0, 0}, size}, {}, true);
    for (const MapPoint& point : inspection.initialization->points) {
      const Vector3d c = to_camera(inspection.initialization->cameras[3], point.position);
      const Vector2d in_image = to_screen(mapping, project(recording->camera, c));
      EXPECT_LT((*on_screen(camera, point.position, {{0, 0}, size}) - in_image).norm(), 1e-4);
    }
  }
}

TEST_F(SceneGeometry, NiceLengthsAreOneTwoFive) {
  for (const auto& [most, nice] : {std::pair{0.07, 0.05}, {1.0, 1.0}, {4.9, 2.0}, {999.0, 500.0}})
    EXPECT_DOUBLE_EQ(nice_length(most), nice);
}

Matrix3d some_covariance() {
  Matrix3d L;
  L << 0.02, 0, 0, 0.01, 0.005, 0, -0.004, 0.002, 0.01;
  return L * L.transpose();
}

TEST(UncertaintyGeometry, RegionsContain95Percent) {
  const double x = kChiSquare3, pi = std::numbers::pi;
  EXPECT_NEAR(1 - std::exp(-kChiSquare2 / 2), 0.95, 1e-4);
  EXPECT_NEAR(std::erf(std::sqrt(x / 2)) - std::sqrt(2 * x / pi) * std::exp(-x / 2), 0.95, 1e-4);
}

TEST(UncertaintyGeometry, LinesAreOnTheEllipsoidAroundTheCenter) {
  const Vector3d center(1, -2, 0.5);
  const Matrix3d information = some_covariance().inverse();
  for (const double enlarged : {1.0, 10.0})
    for (const auto& line : confidence_ellipsoid(center, some_covariance(), enlarged))
      for (const Vector3d& point : line) {
        const Vector3d from = (point - center) / enlarged;
        EXPECT_NEAR(from.dot(information * from), kChiSquare3, 1e-6);
      }
  for (const auto& line : confidence_ellipsoid(center, Matrix3d::Zero(), 100))
    for (const Vector3d& point : line) EXPECT_EQ(point, center);
}

TEST(UncertaintyGeometry, RimHasTheAnglesOf95PercentButAtMostARightAngle) {
  const NormalArrow arrow{Vector3d(1, 2, 3), Vector3d(1, 2, 5)};
  const Matrix3d covariance = Vector3d(1e-4, 4e-4, 0).asDiagonal();
  std::vector<double> angles;
  for (const Vector3d& end : confidence_rim(arrow, covariance, 1)) {
    EXPECT_NEAR((end - arrow.base).norm(), 2, 1e-9);
    angles.push_back(std::acos((end - arrow.base).normalized().z()));
  }
  const auto [least, most] = std::ranges::minmax(angles);
  EXPECT_NEAR(least, 0.01 * std::sqrt(kChiSquare2), 1e-6);
  EXPECT_NEAR(most, 0.02 * std::sqrt(kChiSquare2), 1e-6);
  const NormalArrow unit{Vector3d::Zero(), Vector3d::UnitZ()};
  const Matrix3d large = Vector3d(1e-2, 1e-2, 0).asDiagonal();
  for (const Vector3d& end : confidence_rim(unit, large, 100)) EXPECT_NEAR(end.z(), 0, 1e-12);
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
  std::vector<double> angles;
  for (const Vector2d& disc : confidence_on_disc(normal, covariance))
    angles.push_back(angle_deg(normal_from_disc(disc), normal));
  const auto [least, most] = std::ranges::minmax(angles);
  EXPECT_NEAR(most, degrees(0.02 * std::sqrt(kChiSquare2)), 1e-3);
  EXPECT_NEAR(least, degrees(0.01 * std::sqrt(kChiSquare2)), 1e-3);
}

class SolidModels : public testing::Test {
 protected:
  static std::string error_of(const std::string& file) {
    return test::error_of([&] { read_solid_model(file); });
  }

  test::TestFolder folder_;
};

/// A wedge 4 wide (x), 2 deep and 3 high, with a low front at z = 2; y is up.
constexpr const char* kWedgeObj =
    "v 10 5 0\nv 14 5 0\nv 14 5 2\nv 10 5 2\nv 10 8 0\nv 14 8 0\n"
    "f 1 2 3 4\nf 1 5 6 2\nf 4 3 6 5\nf 1 4 5\nf 2 6 3\n";

TEST_F(SolidModels, StandsOnItsFootAndIsOneSideWide) {
  const SolidModel model = read_solid_model(folder_.write("wedge.obj", kWedgeObj));
  EXPECT_EQ(model.triangles.size(), 8U);
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : model.points) box.extend(point);
  EXPECT_LT((box.min() - Vector3d(-0.5, -0.25, 0)).norm(), 1e-6);
  EXPECT_LT((box.max() - Vector3d(0.5, 0.25, 0.75)).norm(), 1e-6);
  EXPECT_NEAR(model.height_sides, 0.75, 1e-6);
  for (const Vector3d& point : model.points)
    EXPECT_TRUE(point.z() < 0.5 || point.y() > 0) << "the low front, z of the file, is at -y";
  EXPECT_EQ(lit_rgb(model, 0, 0xFFFFFF) >> 16, lit_rgb(model, 0, 0xFFFFFF) & 0xFF);
}

TEST_F(SolidModels, IsNotMirroredOnThePlane) {
  const Inspection inspection = made_inspection();
  const auto corners = cube_corners(*inspection.cube, 0.3);
  SolidModel model = read_solid_model("robot");
  const auto placed = placed_on(model, corners);
  const auto volume = [&](const std::vector<Vector3d>& points) {
    double sum = 0;
    for (const auto& [a, b, c] : model.triangles) sum += points[a].dot(points[b].cross(points[c]));
    return sum / 6;
  };
  EXPECT_GT(volume(model.points), 0) << "triangles are counterclockwise from outside";
  EXPECT_NEAR(volume(placed), 0.3 * 0.3 * 0.3 * volume(model.points), 1e-6);
  const Plane& plane = inspection.initialization->plane;
  std::vector<double> heights;
  for (const Vector3d& point : placed) heights.push_back(plane.normal.dot(point) + plane.distance);
  const auto [lowest, highest] = std::ranges::minmax(heights);
  EXPECT_NEAR(lowest, 0, 1e-9);
  EXPECT_NEAR(highest, 0.3 * model.height_sides, 1e-9);
}

TEST_F(SolidModels, ReadsColorsOfAPlyWithZUp) {
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 9\n2 0 0 255 0 9\n0 0 4 255 0 9\n3 0 1 2\n";
  const SolidModel model = read_solid_model(folder_.write("one.ply", ply));
  EXPECT_NEAR(model.height_sides, 2, 1e-6);
  ASSERT_EQ(model.rgb.size(), 1U);
  EXPECT_EQ(model.rgb[0], 0xFF0009U);
}

/// Returns a .glb (glTF 2.0) with a triangle that a node moves and scales.
std::string small_glb() {
  const std::array<float, 9> points = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0,"translation":[0,7,0],"scale":[2,4,2]}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],)"
      R"("accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3",)"
      R"("min":[0,0,0],"max":[1,1,0]}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto word = [](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    return std::string(reinterpret_cast<const char*>(&number), 4);
  };
  const std::string binary(reinterpret_cast<const char*>(points.data()), 36);
  return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + 36) + word(json.size()) + "JSON" +
         json + word(36) + std::string("BIN\0", 4) + binary;
}

TEST_F(SolidModels, AppliesTheNodesOfAGltf) {
  const SolidModel model = read_solid_model(folder_.write("one.glb", small_glb()));
  EXPECT_EQ(model.triangles.size(), 1U);
  EXPECT_NEAR(model.height_sides, 2, 1e-6);
}

TEST_F(SolidModels, ReportsWhyAFileCannotBeRead) {
  EXPECT_THAT(error_of("statue.stl"), HasSubstr("statue.stl: expected .obj, .ply, .gltf or .glb"));
  EXPECT_THAT(error_of("nowhere.obj"), HasSubstr("nowhere.obj: no such file"));
  for (const std::string type : {".obj", ".ply", ".gltf", ".glb"})
    for (const char* text : {"", "what is this?\n"})
      EXPECT_THAT(error_of(folder_.write("bad" + type, text)),
                  HasSubstr(type.starts_with(".gl") ? "found no glTF" : "no triangles found"))
          << type;
  EXPECT_THAT(error_of(folder_.write("point.obj", "v 1 1 1\nf 1 1 1\n")), HasSubstr("point.obj: "));
  EXPECT_THAT(error_of(folder_.write("hole.obj", "v 1 1 1\nf 1 2 99\n")),
              HasSubstr("hole.obj: a triangle refers to point 2 of 1"));
}

}  // namespace
}  // namespace gpo
