// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_cameras.h"
#include "engine/results/result_method.h"
#include "tests/engine/recording/recording_folder.h"
#include "tests/engine/results/written_results.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <random>
#include <utility>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::AllOf, testing::ElementsAre, testing::HasSubstr;

constexpr int kWindowFrames = 12;

/// Transforms into another world and unit: x = 3 (R x_true + p).
Pose elsewhere(const Pose& camera) {
  const Pose moved = Pose{so3_exp({0.3, 2.0, -0.7}), {4, -5, 6}} * camera;
  return {moved.R_wc, 3 * moved.p_wc};
}

/// A window whose true cameras and plane are known, and the result of another program for it.
struct ResultMethod : testing::Test {
  ResultMethod() {
    for (const Pose& camera : truth.cameras) poses.push_back(elsewhere(camera));
  }

  /// Returns points on the true plane in view and as many above it, far to the side.
  Eigen::Matrix3Xd true_points() const {
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

  std::string written(const std::string& name, const std::string& content) const {
    return folder.write(name, content).string();
  }

  /// Initializes the window twice; appends the messages to `lines`.
  Initialization initialized(const std::string& specs) {
    const auto log = [&](const std::string& name, const std::string& line) {
      lines.push_back(name + ": " + line);
    };
    const Method method = result_method(parse_program_result("it=" + specs), log, 0);
    method.initialize_from(truth.window, sources, {});
    return method.initialize_from(truth.window, sources, {});
  }

  void expect_truth(const std::string& specs, double max_normal_error_deg = 0.3) {
    const Initialization result = initialized(specs);
    ASSERT_TRUE(result.ok) << result.reason;
    EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), max_normal_error_deg);
    EXPECT_EQ(result.plane.distance, 1);
    for (int i = 0; i < kWindowFrames; ++i) {
      EXPECT_TRUE(result.cameras[i].p_wc.isApprox(truth.cameras[i].p_wc, 2e-2) || i == 0) << i;
      EXPECT_TRUE(result.cameras[i].R_wc.isApprox(truth.cameras[i].R_wc, 2e-3)) << i;
    }
    EXPECT_TRUE(result.cameras[0].p_wc.isZero(1e-9));
    EXPECT_GT(result.points.size(), 50U);
  }

  const TestFolder folder;
  Simulation truth =
      simulate_fitted({.motion = Motion::wander, .frames = kWindowFrames, .points = 80});
  const std::vector<std::int64_t> times_ns = truth.window.timestamps_ns;
  std::vector<Pose> poses;  ///< one per frame, elsewhere
  Sources sources;
  std::vector<std::string> lines;
};

TEST_F(ResultMethod, FitsThePlaneToPointsTriangulatedFromATrajectory) {
  expect_truth(written("a.txt", tum_text(times_ns, poses)));
  EXPECT_THAT(lines,
              ElementsAre("it: TUM, camera poses; 12 of the window's 12 frames; plane "
                          "through points triangulated from its cameras"));
}

TEST_F(ResultMethod, FitsThePlaneToThePointsOfAColmapModel) {
  std::vector<std::string> names;
  std::vector<Pose> cameras;
  for (int i = 0; i < kWindowFrames; ++i) {
    names.push_back(fmt::format("cam0/{}.png", i));
    names.push_back(fmt::format("cam1/{}.png", i));
    sources.images.push_back(fmt::format("/somewhere/cam0/{}.png", i));
    cameras.push_back(poses[i]);
    cameras.push_back(elsewhere(truth.cameras[i] * Pose{Eigen::Matrix3d::Identity(), {0.2, 0, 0}}));
  }
  folder.write("m/images.bin", colmap_images_binary(names, cameras));
  folder.write("m/points3D.bin", colmap_points_binary(true_points()));
  const auto model = (folder.path() / "m").string();
  expect_truth(model);
  EXPECT_THAT(lines,
              ElementsAre(AllOf(HasSubstr("COLMAP"), HasSubstr("plane through its points"))));
  for (auto& image : sources.images) image = "/elsewhere" / image.filename();
  EXPECT_THAT(initialized(model).reason, HasSubstr("it: two of its images are named 0.png"));
}

TEST_F(ResultMethod, FindsImagesNamedAfterTheirTimeStamp) {
  std::vector<std::string> names;
  for (const std::int64_t time : times_ns) names.push_back(std::to_string(time + 1000) + ".jpg");
  expect_truth(written("images.txt", colmap_images_text(names, poses)));
}

TEST_F(ResultMethod, FindsKittiFramesByNumber) {
  poses.insert(poses.begin(), 3, Pose{});
  truth.window.start = 3;
  const auto file = written("00.txt", kitti_text(poses));
  expect_truth(file);
  truth.window.start = 14;
  EXPECT_THAT(
      initialized(file).reason,
      HasSubstr("it: has 1 of the window's 12 frames, expected at least 3 over half of it; it "
                "has 15 lines"));
}

TEST_F(ResultMethod, TransformsBodyPosesToTheCamera) {
  const Pose T_body_camera{so3_exp({0.1, -1.6, 0.4}), {0.02, 0.05, -0.01}};
  for (Pose& pose : poses) pose = pose * inverse(T_body_camera);
  const auto vins = written("vins.csv", vins_text(times_ns, poses));
  const auto orb = written("f.txt", tum_text(times_ns, poses, true));
  EXPECT_THAT(initialized(vins).reason, HasSubstr("T_BS"));
  sources.T_body_camera = T_body_camera;
  expect_truth(vins);
  expect_truth(orb + ",frame=body");
  EXPECT_FALSE(initialized(orb).ok) << "as camera poses they do not explain the tracks";
}

// Like ORB-SLAM3's KeyFrameTrajectory.txt.
TEST_F(ResultMethod, ResectsFramesBetweenKeyframes) {
  std::vector<std::int64_t> times;
  std::vector<Pose> keyframes;
  for (int i = 2; i < kWindowFrames; i += 3) {
    times.push_back(times_ns[i]);
    keyframes.push_back(poses[i]);
  }
  const Initialization result =
      initialized(written("KeyFrameTrajectory.txt", tum_text(times, keyframes)));
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_LT(angle_deg(result.plane.normal, truth.plane.normal), 1);
  EXPECT_THAT(lines,
              ElementsAre(HasSubstr("4 of the window's 12 frames (6 in gaps of up to 0.1 s "
                                    "between poses), the others resected")));
}

TEST_F(ResultMethod, RejectsWindowThatIsNotCovered) {
  auto times = times_ns;
  const auto first = [&](int count) {
    return initialized(written("a.txt",
                               tum_text({times.begin(), times.begin() + count},
                                        {poses.begin(), poses.begin() + count})))
        .reason;
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

TEST(ResultIdentity, ChangesWithOneByteOfEachFile) {
  const TestFolder folder;
  const auto identity = [&](const std::string& poses, const std::string& points) {
    const std::string text = fmt::format("mine={},{}",
                                         folder.write("path.txt", poses).string(),
                                         folder.write("points3D.txt", points).string());
    return result_method(
               parse_program_result(text), [](auto&&...) {}, 0)
        .identity;
  };
  const std::string poses = "0 0 0 0 0 0 0 1\n0.1 1 0 0 0 0 0 1\n";
  const std::string points = "1 1 2 3 0 0 0 0.5\n";
  const std::string first = identity(poses, points);
  EXPECT_EQ(identity(poses, points), first);
  EXPECT_NE(identity("0 0 0 0 0 0 0 1\n0.1 2 0 0 0 0 0 1\n", points), first);
  EXPECT_NE(identity(poses, "1 1 2 4 0 0 0 0.5\n"), first);
}

TEST_F(ResultMethod, ReadsPointsFromASeparateFileAndNeedsTenInView) {
  const auto trajectory = written("a.txt", tum_text(times_ns, poses));
  // The points are exact.
  expect_truth(trajectory + "," + written("a.ply", ply_binary(true_points())), 1e-6);
  EXPECT_THAT(lines, ElementsAre(HasSubstr("plane through its points")));
  const Eigen::Matrix3Xd points = true_points();
  EXPECT_TRUE(plane_in_view(points, elsewhere(Pose{}), truth.window));
  EXPECT_FALSE(plane_in_view(points.leftCols(10), elsewhere(Pose{}), truth.window));
  EXPECT_FALSE(plane_in_view(Eigen::Matrix3Xd(3, 0), elsewhere(Pose{}), truth.window));
}

TEST_F(ResultMethod, InterpolatesBetweenPosesAndCorrectsAStatedTimeOffset) {
  const std::int64_t half_ns = (times_ns[1] - times_ns[0]) / 2;
  std::vector<std::int64_t> later = times_ns;
  for (std::int64_t& time : later) time += half_ns;
  const auto shifted = written("a.txt", tum_text(later, poses));
  expect_truth(shifted + fmt::format(",offset={:.9f}", -1e-9 * static_cast<double>(half_ns)));
  EXPECT_THAT(lines, testing::Contains(HasSubstr("12 of the window's 12 frames; plane")));
  lines.clear();
  const Initialization uncorrected = initialized(shifted);
  EXPECT_THAT(lines,
              testing::Contains(HasSubstr(
                  "11 of the window's 12 frames (11 interpolated), the others resected")));
  ASSERT_TRUE(uncorrected.ok) << uncorrected.reason;
  EXPECT_GT(so3_log(uncorrected.cameras[3].R_wc.transpose() * truth.cameras[3].R_wc).norm(), 1e-4)
      << "a pose of another time must not pass for that of a frame";
}

TEST_F(ResultMethod, DoesNotInterpolateOverGaps) {
  auto times = times_ns;
  times.erase(times.begin() + 4, times.begin() + 7);
  poses.erase(poses.begin() + 4, poses.begin() + 7);
  const Initialization result = initialized(written("a.txt", tum_text(times, poses)));
  ASSERT_TRUE(result.ok) << result.reason;
  EXPECT_THAT(lines,
              ElementsAre(HasSubstr("9 of the window's 12 frames (3 in gaps of up to 0.133 s "
                                    "between poses), the others resected")));
}

TEST_F(ResultMethod, IsMetricIfItsBodyPosesAreOrTheUserSaysSo) {
  const auto scale = [&](const std::string& specs) {
    const Method method = result_method(parse_program_result("it=" + specs), {}, 0);
    ImportedResult imported;
    const BoundMethod initialize =
        recording_method(method)->bind({.T_body_camera = sources.T_body_camera});
    const Initialization result = initialize(truth.window, sources, imported);
    EXPECT_TRUE(result.ok) << result.reason;
    return imported.meters_per_unit;
  };
  const auto tum = written("a.txt", tum_text(times_ns, poses));
  EXPECT_FALSE(scale(tum));
  const auto metric = scale(tum + ",scale=metric");
  ASSERT_TRUE(metric);
  EXPECT_NEAR(*metric, 3 * truth.plane.distance, 0.02) << "its unit is a third of the truth's";
  sources.T_body_camera = Pose{};
  const auto vins = written("vins.csv", vins_text(times_ns, poses));
  EXPECT_TRUE(scale(vins));
  EXPECT_FALSE(scale(vins + ",scale=free"));
}

TEST_F(ResultMethod, ReadsTheFileOfEachRecording) {
  written("one.txt", tum_text(times_ns, poses));
  written("broken.txt", "hello\n");
  const auto pattern = (folder.path() / "{recording}.txt").string();
  const Method method = result_method(parse_program_result("it=" + pattern), {}, 0);
  const RecordingMethod* result = recording_method(method);
  ASSERT_NE(result, nullptr);
  ImportedResult imported;
  EXPECT_TRUE(result->bind({.name = "one"})(truth.window, sources, imported).ok);
  EXPECT_THAT(error_of([&] { result->bind({.name = "two"}); }), HasSubstr("two.txt"));
  EXPECT_THAT(error_of([&] { result->bind({}); }), HasSubstr("this one has none"));
  EXPECT_TRUE(result->identity_for("one"));
  EXPECT_FALSE(result->identity_for("two"));
  EXPECT_THAT(error_of([&] { result->identity_for("broken"); }), HasSubstr("broken.txt"));
  const auto before = result->identity_for("one");
  poses[2].p_wc.x() += 1;
  written("one.txt", tum_text(times_ns, poses));
  EXPECT_NE(result->identity_for("one"), before);
}

TEST_F(ResultMethod, RejectsATimeOffsetOfPosesWithoutTimes) {
  EXPECT_THAT(error_of([&] { initialized(written("00.txt", kitti_text(poses)) + ",offset=auto"); }),
              AllOf(HasSubstr("00.txt"), HasSubstr("has no times, remove ,offset=")));
}

TEST_F(ResultMethod, RejectsInvalidText) {
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {"it=a,offset=soon", "'offset=soon', expected auto or seconds"},
           {"it=a,offset=1e9", "expected auto or seconds of at most 1e+06"},
           {"it=a,scale=big", "--result: scale: unknown value 'big'"},
           {"it", "--result: 'it', expected NAME=FILE"},
           {"it=", "--result: 'it='"},
           {"a b=c", "--result"},
           {"it=,,", "names no file"},
           {"it=a,b,c", "expected NAME=FILE"},
           {"it=a,frame=wheel", "--result: frame: unknown value 'wheel'"}})
    EXPECT_THAT(error_of([&, &text = text] { parse_program_result(text); }), HasSubstr(message));
}

}  // namespace
}  // namespace gpo::test
