// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"
#include "tests/engine/recording/recording_folder.h"
#include "tests/engine/results/written_results.h"
#include "tests/engine/simulated_window.h"
#include "tests/engine/test_folder.h"

#include <limits>
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
           {"it=a,offset=1e9", "expected auto or seconds"},
           {"it=a,scale=big", "unknown"},
           {"it", "--result: 'it', expected NAME=FILE"},
           {"it=", "--result: 'it='"},
           {"a b=c", "--result"},
           {"it=,,", "names no file"},
           {"it=a,b,c", "expected NAME=FILE"},
           {"it=a,frame=wheel", "unknown"}})
    EXPECT_THAT(error_of([&, &text = text] { parse_program_result(text); }), HasSubstr(message));
}

const std::vector<std::int64_t> kTimes_ns = {
    1'520'530'308'199'447'626, 1'520'530'308'232'780'959, 1'520'530'308'266'114'293};

std::vector<Pose> poses() {
  std::vector<Pose> poses;
  for (int i = 0; i < 3; ++i)
    poses.push_back({so3_exp({0.1 * i, -0.4, 2.2}), {1.5 - i, 0.25 * i, -3}});
  return poses;
}

void expect_poses(const ResultPoses& read, FoundBy by, PosedFrame frame) {
  EXPECT_EQ(read.by, by) << read.layout;
  EXPECT_EQ(read.frame, frame) << read.layout;
  ASSERT_EQ(read.poses.size(), 3U) << read.layout;
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(read.poses[i].R_wc.isApprox(poses()[i].R_wc, 1e-9)) << read.layout;
    EXPECT_TRUE(read.poses[i].p_wc.isApprox(poses()[i].p_wc, 1e-9)) << read.layout;
  }
}

TEST(ResultPoses, ReadsEveryTrajectoryFormatAndTheFrameInAnEurocHeader) {
  const TestFolder folder;
  const auto read = [&](const std::string& text) {
    return read_result_poses(folder.write("a.txt", text));
  };
  const auto tum = read(tum_text(kTimes_ns, poses()));
  expect_poses(tum, FoundBy::time, PosedFrame::camera);
  EXPECT_THAT(tum.timestamps_ns, testing::ElementsAreArray(kTimes_ns));
  const auto vins = read(vins_text(kTimes_ns, poses()));
  expect_poses(vins, FoundBy::time, PosedFrame::body);
  EXPECT_THAT(vins.timestamps_ns, testing::ElementsAreArray(kTimes_ns));
  expect_poses(read(kitti_text(poses())), FoundBy::number, PosedFrame::camera);
  // ORB-SLAM3 prints a double of seconds times 1e9, with six meaningless decimals.
  const auto orb = read(tum_text(kTimes_ns, poses(), true));
  expect_poses(orb, FoundBy::time, PosedFrame::camera);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(orb.timestamps_ns[i] - kTimes_ns[i]), 0, 300);
  const std::string rows = vins_text(kTimes_ns, poses());
  const auto frame_of = [&](const std::string& header) {
    return read_result_poses(folder.write("data.csv", header + rows)).frame;
  };
  EXPECT_EQ(frame_of("#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z,v,v,v,\n"), PosedFrame::body);
  EXPECT_EQ(frame_of("#timestamp [ns],p_x,p_y,p_z,q_w,q_x,q_y,q_z; camera to world; world = it\n"),
            PosedFrame::camera);
}

TEST(ResultPoses, ReadsSecondsWithCommasAndCountsRepeatedRows) {
  const TestFolder folder;
  std::string text = tum_text(kTimes_ns, poses());
  std::ranges::replace(text, ' ', ',');
  expect_poses(read_result_poses(folder.write("a.csv", text)), FoundBy::time, PosedFrame::camera);
  const auto named =
      read_result_poses(folder.write("b.csv", "timestamp,tx,ty,tz,qx,qy,qz,qw\n" + text));
  EXPECT_EQ(named.layout, "TUM with commas");
  EXPECT_THAT(named.timestamps_ns, testing::ElementsAreArray(kTimes_ns));
  std::string twice;
  for (const std::string& row : split(tum_text(kTimes_ns, poses()), '\n'))
    if (!row.empty()) twice += row + "\n" + row + "\n";
  const auto repeated = read_result_poses(folder.write("c.txt", twice));
  expect_poses(repeated, FoundBy::time, PosedFrame::camera);
  EXPECT_EQ(repeated.repeats, 3);
}

TEST(ResultPoses, ReadsModelsInTextAndBinary) {
  const TestFolder folder;
  const std::vector<std::string> names = {"cam0/1.png", "cam0/with blanks.png", "cam0/3.png"};
  const Eigen::Matrix3Xd points = Eigen::Matrix3Xd::Random(3, 20);
  folder.write("text/images.txt", colmap_images_text(names, poses()));
  folder.write("text/points3D.txt", colmap_points_text(points));
  folder.write("binary/images.bin", colmap_images_binary(names, poses()));
  folder.write("binary/points3D.bin", colmap_points_binary(points));
  for (const char* path : {"text", "text/images.txt", "binary"}) {
    const auto model = read_result_poses(folder.path() / path);
    expect_poses(model, FoundBy::name, PosedFrame::camera);
    EXPECT_THAT(model.names, testing::ElementsAreArray(names));
  }
  folder.write("a.ply", ply_text(points));
  folder.write("b.ply", ply_binary(points));
  for (const auto& [path, tolerance] : {std::pair("text", 1e-9),
                                        std::pair("binary", 1e-12),
                                        std::pair("a.ply", 1e-9),
                                        std::pair("b.ply", 1e-12)})
    EXPECT_TRUE(read_result_points(folder.path() / path).isApprox(points, tolerance)) << path;
}

std::string error(const std::string& name, const std::string& content) {
  const TestFolder folder;
  const auto file = folder.write(name, content);
  return error_of([&] {
    name.starts_with("images") ? void(read_result_poses(file)) : void(read_result_points(file));
  });
}

TEST(ResultPoses, ReportsErrorsOfTrajectoriesByLine) {
  const TestFolder folder;
  const std::string good = tum_text(kTimes_ns, poses());
  const std::string kitti = kitti_text(poses());
  for (const auto& [content, message] : std::vector<Refusal>{
           {"", "no row of numbers"},
           {"hello\n", "no row of numbers"},
           {"1 2 3\n", "rows of 3 numbers"},
           {good + "1520530309.1 0 0 0 0 0 0 0\n", "t.txt:4: found a quaternion of norm 0"},
           {good + "1520530309.1 0 0 nan 0 0 0 1\n", "t.txt:4"},
           {good + "1520530309.1 0 0 1e400 0 0 0 1\n", "t.txt:4"},
           {good + "1520530309.1 0 0 1e13 0 0 0 1\n", "pose 4: found a position beyond 1e+12"},
           {good + "1520530309.1 0 0\n", "t.txt:4: found 3 columns"},
           {good + good, "t.txt:4"},
           {kitti + "1 0 0 0 0 1 0 0 0 0 -1 0\n", "t.txt:4: found a matrix that is not a rotation"},
           {kitti + "1 0 0 0 0 1 0 0 0 0 1\n", "t.txt:4: found 11 columns"},
           {kitti + "0 0 0 0 0 0 0 0 0 0 0 0\n", "t.txt:4: found a matrix that is not a rotation"}})
    EXPECT_THAT(
        error_of([&, &content = content] { read_result_poses(folder.write("t.txt", content)); }),
        HasSubstr(message));
  EXPECT_THAT(error_of([&] { read_result_poses(folder.path()); }),
              HasSubstr("found neither images.bin nor images.txt"));
  EXPECT_THAT(error_of([&] { read_result_poses(folder.path() / "nowhere.txt"); }),
              HasSubstr("nowhere.txt: no such file"));
}

TEST(ResultPoses, ReportsErrorsOfTextModelsByLineAndOfBinaryModelsByEntry) {
  for (const auto& [name, content, message] : std::vector<std::array<std::string, 3>>{
           {"images.txt", "# only a comment\n", "found no image"},
           {"images.txt", "1 0 0 0 0 0 0 0 1 a.png\n\n", "txt:1: found a quaternion of norm 0"},
           {"images.txt",
            "1 1 0 0 0 0 0 0 1 a.png\n\n2 1 0 0 0 0 x 0 1 b.png\n",
            "images.txt:3: found \"x\""},
           {"images.txt", "1 1 0 0 0 0 0 0 1\n", "no image name"},
           {"images.txt", "1 1 0 0\n", "the end of the line"},
           {"points3D.txt", "1 2 3 nan 0 0 0 0\n", "points3D.txt:1"},
           {"points3D.txt", "1 2 3 1e99 0 0 0 0\n", "points3D.txt:1"}})
    EXPECT_THAT(error(name, content), HasSubstr(message));
  // Truncated anywhere, or with any counts.
  const std::string images = colmap_images_binary({"a", "b", "c"}, poses());
  const std::string points = colmap_points_binary(Eigen::Matrix3Xd::Ones(3, 2));
  for (std::size_t size = 0; size < images.size(); ++size)
    EXPECT_THAT(error("images.bin", images.substr(0, size)), HasSubstr("images.bin")) << size;
  for (std::size_t size = 0; size < points.size(); ++size)
    EXPECT_THAT(error("points3D.bin", points.substr(0, size)), HasSubstr("points3D.bin")) << size;
  const std::string many = bytes_of(std::uint64_t{1} << 60);
  EXPECT_THAT(error("images.bin", many + images.substr(8)), HasSubstr("image 4, byte"));
  EXPECT_THAT(error("points3D.bin", many + points.substr(8)), HasSubstr("point 3, byte"));
  EXPECT_THAT(error("points3D.bin", points + "x"), HasSubstr("1 bytes after the last"));
  std::string long_list = points;
  long_list.replace(8 + 43, 8, many);
  EXPECT_THAT(error("points3D.bin", long_list), HasSubstr("point 1, byte 8: found a list of"));
  std::string nan = points;
  nan.replace(16, 8, bytes_of(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_THAT(error("points3D.bin", nan), HasSubstr("point 1, byte 8"));
  std::string zero = images;
  zero.replace(12, 32, std::string(32, '\0'));
  EXPECT_THAT(error("images.bin", zero),
              HasSubstr("image 1, byte 8: found a quaternion of norm 0"));
  EXPECT_THAT(error("images.bin", bytes_of(std::uint64_t{0})), HasSubstr("no image"));
}

TEST(ResultPoses, ReportsErrorsOfPlyByLineOrVertex) {
  const TestFolder folder;
  const auto error = [&](const std::string& content) {
    return error_of([&] { read_result_points(folder.write("a.ply", content)); });
  };
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\nend_header\n";
  for (const auto& [content, message] : std::vector<Refusal>{
           {"ply\n", "the end of the file"},
           {head + "end_header\n", "no vertices with x, y and z"},
           {head + xyz + "1 2 3\n", "2 vertices in 6 bytes"},
           {head + xyz + "1 2 3\n4 5\n", "a.ply:9: found 2 numbers"},
           {head + xyz + "1 2 3\n4 5 nan\n", "a.ply:9"},
           {head + xyz + "1 2 3\n4 5 1e30\n", "vertex 2"},
           {head + "property list uchar int x\n", "a.ply:4: found a list"},
           {head + "property half x\n", "kind half"},
           {head + "element vertex 3\n", "vertices again"},
           {"ply\nformat binary_big_endian 1.0\nelement vertex 0\n" + xyz, "binary_big_endian"},
           {"ply\nformat ascii 1.0\nelement vertex 1152921504606846976\n" + xyz,
            "vertices in 0 bytes"},
           {"ply\nformat ascii 1.0\nelement vertex -1\n" + xyz, "-1 vertices"},
           {"ply\nelement face 1\n", "the vertices first"}})
    EXPECT_THAT(error(content), HasSubstr(message));
  const std::string binary = ply_binary(Eigen::Matrix3Xd::Ones(3, 4));
  const std::size_t body = binary.find("end_header\n") + 11;
  for (std::size_t size = 3; size < body + 4 * 25; ++size)
    EXPECT_THAT(error(binary.substr(0, size)), HasSubstr("a.ply")) << size;
}

}  // namespace
}  // namespace gpo::test
