// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/results/result_method.h"
#include "tests/engine/recording/recording_folder.h"
#include "tests/engine/results/written_results.h"
#include "tests/engine/test_folder.h"

#include <limits>
#include <utility>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

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

TEST(ResultPoses, LeavesOutRowsWithoutAPose) {
  const TestFolder folder;
  const std::string lost = std::to_string(1e-9 * static_cast<double>(kTimes_ns.back() + 1'000'000));
  const auto result = read_result_poses(
      folder.write("a.txt", tum_text(kTimes_ns, poses()) + lost + " nan nan nan 0 0 0 1\n"));
  expect_poses(result, FoundBy::time, PosedFrame::camera);
  EXPECT_EQ(result.unmeasured, 1);
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
           {good + "1520530309.1 0 0 far 0 0 0 1\n", "t.txt:4: found \"far\""},
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
