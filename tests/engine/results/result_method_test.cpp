// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"

#include "tests/engine/results/written_results.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kFrames = 12;

test::Simulation simulation() {
  return test::with_fitted_homographies(
      test::simulate({.motion = test::Motion::wander, .frames = kFrames, .points = 80}));
}

/// Transforms into another world and unit: x = 3 (R x_true + p).
Pose elsewhere(const Pose& camera) {
  const Pose moved = Pose{so3_exp({0.3, 2.0, -0.7}), {4, -5, 6}} * camera;
  return {moved.R_wc, 3 * moved.p_wc};
}

std::vector<Pose> all_elsewhere(const std::vector<Pose>& cameras) {
  std::vector<Pose> moved;
  for (const Pose& camera : cameras) moved.push_back(elsewhere(camera));
  return moved;
}

/// Returns points on the true plane in view and as many above it, far to the side.
Eigen::Matrix3Xd true_points(const test::Simulation& truth) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(0, 1);
  Eigen::Matrix3Xd points(3, 400);
  for (int j = 0; j < points.cols(); ++j) {
    const Eigen::Vector3d ray(anywhere(random) * 0.8 - 0.4, anywhere(random) * 0.6 - 0.3, 1);
    const auto on_plane = intersect(truth.plane, Pose{}, ray);
    const Eigen::Vector3d aside(9 + anywhere(random), anywhere(random), anywhere(random));
    points.col(j) =
        elsewhere({Eigen::Matrix3d::Identity(), j % 2 == 0 && on_plane ? *on_plane : aside}).p_wc;
  }
  return points;
}

Initialization initialized(const std::string& specs,
                           const Window& window,
                           const Sources& sources = {},
                           std::vector<std::string>* lines = nullptr) {
  const auto log = [&](const std::string& name, const std::string& line) {
    if (lines != nullptr) lines->push_back(name + ": " + line);
  };
  const Method method = result_method(parse_program_result("it=" + specs), log, 0);
  method.initialize_from(window, sources, {});
  return method.initialize_from(window, sources, {});
}

void expect_truth(const Initialization& result, const test::Simulation& truth) {
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 0.3);
  EXPECT_EQ(result.plane.distance, 1);
  for (int i = 0; i < kFrames; ++i) {
    EXPECT_TRUE(result.cameras[i].p_wc.isApprox(truth.cameras[i].p_wc, 2e-2) || i == 0) << i;
    EXPECT_TRUE(result.cameras[i].R_wc.isApprox(truth.cameras[i].R_wc, 2e-3)) << i;
  }
  EXPECT_TRUE(result.cameras[0].p_wc.isZero(1e-9));
  EXPECT_GT(result.points.size(), 50U);
}

TEST(ResultMethod, FitsThePlaneToPointsTriangulatedFromATrajectory) {
  const TestFolder folder;
  const auto truth = simulation();
  const auto file = folder.write(
      "a.txt", test::tum_text(truth.window.timestamps_ns, all_elsewhere(truth.cameras)));
  std::vector<std::string> lines;
  expect_truth(initialized(file.string(), truth.window, {}, &lines), truth);
  EXPECT_THAT(lines,
              ElementsAre("it: TUM, camera poses; 12 of the window's 12 frames; plane "
                          "through points triangulated from its cameras"));
}

TEST(ResultMethod, FitsThePlaneToThePointsOfAColmapModel) {
  const TestFolder folder;
  const auto truth = simulation();
  std::vector<std::string> names;
  Sources sources;
  for (int i = 0; i < kFrames; ++i) {
    names.push_back(fmt::format("cam0/{}.png", i));
    names.push_back(fmt::format("cam1/{}.png", i));
    sources.images.push_back(fmt::format("/somewhere/cam0/{}.png", i));
  }
  std::vector<Pose> cameras;
  for (const Pose& camera : truth.cameras) {
    cameras.push_back(elsewhere(camera));
    cameras.push_back(elsewhere(camera * Pose{Eigen::Matrix3d::Identity(), {0.2, 0, 0}}));
  }
  folder.write("m/images.bin", test::colmap_images_binary(names, cameras));
  folder.write("m/points3D.bin", test::colmap_points_binary(true_points(truth)));
  std::vector<std::string> lines;
  const auto model = (folder.path() / "m").string();
  expect_truth(initialized(model, truth.window, sources, &lines), truth);
  EXPECT_THAT(lines,
              ElementsAre(AllOf(HasSubstr("COLMAP"), HasSubstr("plane through its points"))));
  for (auto& image : sources.images) image = "/elsewhere" / image.filename();
  EXPECT_THAT(initialized(model, truth.window, sources).reason,
              HasSubstr("it: two of its images are named 0.png"));
}

TEST(ResultMethod, FindsImagesNamedAfterTheirTimeStamp) {
  const TestFolder folder;
  const auto truth = simulation();
  std::vector<std::string> names;
  for (const std::int64_t time : truth.window.timestamps_ns)
    names.push_back(std::to_string(time + 1000) + ".jpg");
  const auto file =
      folder.write("images.txt", test::colmap_images_text(names, all_elsewhere(truth.cameras)));
  expect_truth(initialized(file.string(), truth.window), truth);
}

TEST(ResultMethod, FindsKittiFramesByNumber) {
  const TestFolder folder;
  auto truth = simulation();
  std::vector<Pose> poses = all_elsewhere(truth.cameras);
  poses.insert(poses.begin(), 3, Pose{});
  truth.window.start = 3;
  const auto file = folder.write("00.txt", test::kitti_text(poses));
  expect_truth(initialized(file.string(), truth.window), truth);
  truth.window.start = 14;
  EXPECT_THAT(
      initialized(file.string(), truth.window).reason,
      HasSubstr("it: has 1 of the window's 12 frames, expected at least 3 over half of it; it "
                "has 15 lines"));
}

TEST(ResultMethod, TransformsBodyPosesToTheCamera) {
  const TestFolder folder;
  const auto truth = simulation();
  const Pose T_body_camera{so3_exp({0.1, -1.6, 0.4}), {0.02, 0.05, -0.01}};
  std::vector<Pose> bodies;
  for (const Pose& camera : truth.cameras) {
    const Pose moved = elsewhere(camera);
    bodies.push_back(moved * inverse(T_body_camera));
  }
  const auto vins = folder.write("vins.csv", test::vins_text(truth.window.timestamps_ns, bodies));
  const auto orb = folder.write("f.txt", test::tum_text(truth.window.timestamps_ns, bodies, true));
  Sources sources;
  EXPECT_THAT(initialized(vins.string(), truth.window, sources).reason, HasSubstr("T_BS"));
  sources.T_body_camera = T_body_camera;
  expect_truth(initialized(vins.string(), truth.window, sources), truth);
  expect_truth(initialized(orb.string() + ",frame=body", truth.window, sources), truth);
  EXPECT_FALSE(initialized(orb.string(), truth.window, sources).ok)
      << "as camera poses they do not explain the tracks";
}

// Like ORB-SLAM3's KeyFrameTrajectory.txt.
TEST(ResultMethod, ResectsFramesBetweenKeyframes) {
  const TestFolder folder;
  const auto truth = simulation();
  std::vector<std::int64_t> times;
  std::vector<Pose> poses;
  for (int i = 2; i < kFrames; i += 3) {
    times.push_back(truth.window.timestamps_ns[i]);
    poses.push_back(elsewhere(truth.cameras[i]));
  }
  const auto file = folder.write("KeyFrameTrajectory.txt", test::tum_text(times, poses));
  std::vector<std::string> lines;
  const Initialization result = initialized(file.string(), truth.window, {}, &lines);
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1);
  EXPECT_THAT(lines, ElementsAre(HasSubstr("4 of the window's 12 frames, the others resected")));
}

TEST(ResultMethod, RejectsWindowThatIsNotCovered) {
  const TestFolder folder;
  const auto truth = simulation();
  auto times = truth.window.timestamps_ns;
  const auto poses = all_elsewhere(truth.cameras);
  const auto first = [&](int count) {
    const auto file = folder.write("a.txt",
                                   test::tum_text({times.begin(), times.begin() + count},
                                                  {poses.begin(), poses.begin() + count}));
    return initialized(file.string(), truth.window).reason;
  };
  EXPECT_THAT(first(2),
              HasSubstr("it: has 2 of the window's 12 frames, expected at least 3 over half"));
  EXPECT_THAT(first(5), HasSubstr("it: has 5 of the window's 12 frames"));
  EXPECT_EQ(first(7), "");
  for (std::int64_t& time : times) time += 1'000'000'000'000;
  EXPECT_THAT(first(12),
              AllOf(HasSubstr("has 0 of the window's 12 frames"),
                    HasSubstr("it is from 1001.000 to 1001.367 s, the window from 1.000")));
}

TEST(ResultMethod, ReadsPointsFromASeparateFile) {
  const TestFolder folder;
  const auto truth = simulation();
  const auto poses = folder.write(
      "a.txt", test::tum_text(truth.window.timestamps_ns, all_elsewhere(truth.cameras)));
  const auto points = folder.write("a.ply", test::ply_binary(true_points(truth)));
  std::vector<std::string> lines;
  const std::string specs = poses.string() + "," + points.string();
  const Initialization result = initialized(specs, truth.window, {}, &lines);
  expect_truth(result, truth);
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1e-6) << "the points are exact";
  EXPECT_THAT(lines, ElementsAre(HasSubstr("plane through its points")));
}

TEST(ResultMethod, NeedsTenPointsInViewForAPlane) {
  const auto truth = simulation();
  const Eigen::Matrix3Xd points = true_points(truth);
  EXPECT_TRUE(plane_in_view(points, elsewhere(Pose{}), truth.window));
  EXPECT_FALSE(plane_in_view(points.leftCols(10), elsewhere(Pose{}), truth.window));
  EXPECT_FALSE(plane_in_view(Eigen::Matrix3Xd(3, 0), elsewhere(Pose{}), truth.window));
}

TEST(ResultMethod, RejectsInvalidText) {
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"it", "--result: 'it', expected NAME=FILE"},
           {"it=", "--result: 'it='"},
           {"a b=c", "--result"},
           {"it=,,", "names no file"},
           {"it=a,b,c", "expected NAME=FILE"},
           {"it=a,frame=wheel", "unknown"}})
    EXPECT_THAT(error_of([&, &text = text] { parse_program_result(text); }), HasSubstr(message));
}

}  // namespace
}  // namespace gpo
