// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "engine/inspection/report/report.h"
#include "engine/recording/layouts/write_recording.h"
#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/recording/recording_folder.h"

#include <Eigen/Geometry>
#include <fmt/ranges.h>

namespace gpo::test {
namespace {

using testing::Contains, testing::Field, testing::HasSubstr;

constexpr int kFramesOfASet = 5;

cv::Mat color_image(int number) { return {48, 64, CV_8UC3, cv::Scalar::all(10 * number)}; }
cv::Mat depth_image() { return {48, 64, CV_16UC1, cv::Scalar::all(1200)}; }

/// Camera to world.
Pose true_pose(int frame) {
  return {Eigen::AngleAxisd(0.02 * frame, Eigen::Vector3d(1, 2, 3).normalized()).matrix(),
          {0.1 * frame, 0.2, -0.3}};
}

std::string row_major(const Pose& pose, int rows) {
  std::string text;
  for (int i = 0; i < 3; ++i)
    text += fmt::format("{:.12g} {:.12g} {:.12g} {:.12g} ",
                        pose.R_wc(i, 0),
                        pose.R_wc(i, 1),
                        pose.R_wc(i, 2),
                        pose.p_wc[i]);
  return text + (rows == 4 ? "0 0 0 1" : "");
}

std::string all_rows(int rows) {
  std::string text;
  for (int i = 0; i < kFramesOfASet; ++i) text += row_major(true_pose(i), rows) + "\n";
  return text;
}

void expect_true_poses(const Recording& recording, double tolerance = 1e-9) {
  ASSERT_TRUE(recording.truth);
  ASSERT_EQ(recording.truth->poses.size(), static_cast<std::size_t>(kFramesOfASet));
  for (int i = 0; i < kFramesOfASet; ++i) {
    ASSERT_TRUE(recording.truth->poses[i]);
    EXPECT_TRUE(recording.truth->poses[i]->R_wc.isApprox(true_pose(i).R_wc, tolerance)) << i;
    EXPECT_TRUE(recording.truth->poses[i]->p_wc.isApprox(true_pose(i).p_wc, tolerance)) << i;
  }
}

class DataSets : public RecordingFolder {
 protected:
  void write_images(const std::string& pattern, bool depth = false) const {
    for (int i = 0; i < kFramesOfASet; ++i)
      folder.write(fmt::format(fmt::runtime(pattern), i), depth ? depth_image() : color_image(i));
  }
};

TEST_F(DataSets, ReadsKittisTimesLensAndPoses) {
  write_images("sequences/03/image_0/{:06d}.png");
  write_images("sequences/03/image_1/{:06d}.png");
  folder.write("sequences/03/times.txt",
               "0.000000e+00\n1.000000e-01\n2.000000e-01\n3.000000e-01\n4.000000e-01\n");
  folder.write("sequences/03/calib.txt", "P0: 60 0 31 0 0 61 23 0 0 0 1 0\n");
  folder.write("poses/03.txt", all_rows(3));
  const auto recording = open_recording(folder.path() / "sequences/03");
  EXPECT_EQ(recording->frame_count(), kFramesOfASet);
  EXPECT_EQ(recording->timestamps_ns[3], 300'000'000);
  EXPECT_EQ(recording->camera_source, CameraSource::file);
  EXPECT_EQ(recording->camera.fy, 61);
  expect_true_poses(*recording);
  EXPECT_THAT(recording->files,
              Contains(Field(&FoundFile::reason, HasSubstr("5 images: another sequence"))));
}

TEST_F(DataSets, ReadsTheColorImagesAndPosesOfSevenScenes) {
  write_images("frame-{:06d}.color.png");
  write_images("frame-{:06d}.depth.png", true);
  for (int i = 0; i < kFramesOfASet; ++i)
    folder.write(fmt::format("frame-{:06d}.pose.txt", i), row_major(true_pose(i), 4));
  const auto recording = open();
  EXPECT_EQ(recording->frame_count(), kFramesOfASet);
  EXPECT_EQ(recording->images->bgr(2).at<cv::Vec3b>(0, 0)[0], 20);
  expect_true_poses(*recording);
  EXPECT_THAT(recording->files,
              Contains(Field(&FoundFile::reason, HasSubstr("5 images: depth, by its name"))));
}

const std::string kNoPoses[] = {"nan nan nan nan nan nan nan nan nan nan nan nan 0 0 0 1",
                                "-inf inf 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                                "-1.#IND 1.#QNAN 0 0 0 1 0 0 0 0 1 0 0 0 0 1",
                                "0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 0"};

TEST_F(DataSets, ReadsSevenScenesWithAFrameThatWasNotTracked) {
  write_images("frame-{:06d}.color.png");
  for (const std::string& lost : kNoPoses) {
    for (int i = 0; i < kFramesOfASet; ++i)
      folder.write(fmt::format("frame-{:06d}.pose.txt", i),
                   i == 3 ? lost : row_major(true_pose(i), 4));
    const auto recording = open();
    ASSERT_TRUE(recording->truth) << lost;
    for (int i = 0; i < kFramesOfASet; ++i)
      EXPECT_EQ(recording->truth->poses[i].has_value(), i != 3);
    EXPECT_THAT(recording->notes, Contains("1 of 5 images have no pose in the ground truth"));
  }
  for (int i = 0; i < kFramesOfASet; ++i)
    folder.write(fmt::format("frame-{:06d}.pose.txt", i), kNoPoses[0]);
  EXPECT_FALSE(open()->truth);
  EXPECT_THAT(open()->notes,
              Contains("no ground truth from 7-Scenes: " + file("frame-000000.pose.txt") +
                       ": found a matrix that is no pose, expected a rotation and a translation"));
}

TEST_F(DataSets, ReadsReplicaWithARowThatIsNoPose) {
  write_images("results/frame{:06d}.jpg");
  for (const std::string& lost : kNoPoses) {
    std::string rows = lost + "\n";
    for (int i = 1; i < kFramesOfASet; ++i) rows += row_major(true_pose(i), 4) + "\n";
    folder.write("traj.txt", rows);
    const auto recording = open();
    ASSERT_TRUE(recording->truth) << lost;
    EXPECT_FALSE(recording->truth->poses[0]);
    EXPECT_TRUE(recording->truth->poses[1]);
    EXPECT_THAT(recording->notes, Contains("1 of 5 images have no pose in the ground truth"));
  }
  folder.write("traj.txt", "1 2 three\n");
  EXPECT_THAT(open()->notes, Contains(HasSubstr("traj.txt:1: found no number, expected")));
}

TEST_F(DataSets, ReadsReplicasScene) {
  write_images("room/results/frame{:06d}.jpg");
  write_images("room/results/depth{:06d}.png", true);
  folder.write("room/traj.txt", all_rows(4));
  folder.write("cam_params.json",
               R"({"camera": {"w": 64, "h": 48, "fx": 60, "fy": 61, "cx": 31, "cy": 23}})");
  const auto recording = open_recording(folder.path() / "room");
  EXPECT_EQ(recording->frame_count(), kFramesOfASet);
  EXPECT_EQ(recording->camera.fx, 60);
  expect_true_poses(*recording);
}

TEST_F(DataSets, ReadsAColmapProject) {
  write_images("images/frame_{:05d}.jpg");
  folder.write("sparse/0/cameras.txt", "1 PINHOLE 64 48 60 61 31.5 23.5\n");
  std::string images;
  for (int i = kFramesOfASet - 1; i >= 0; --i) {
    const Pose T_cw = inverse(true_pose(i));
    const Eigen::Quaterniond q(T_cw.R_wc);
    images += fmt::format("{} {} {} {} {} {} 1 frame_{:05d}.jpg\n\n",
                          i + 1,
                          q.w(),
                          q.x(),
                          q.y(),
                          q.z(),
                          fmt::join(T_cw.p_wc, " "),
                          i);
  }
  folder.write("sparse/0/images.txt", images);
  const auto recording = open();
  EXPECT_EQ(recording->camera.cx, 31);
  expect_true_poses(*recording);
}

TEST_F(DataSets, ReadsNerfstudiosPoses) {
  write_images("images/frame_{:05d}.png");
  std::string frames;
  for (int i = 0; i < kFramesOfASet; ++i) {
    Pose gl = true_pose(i);
    gl.R_wc = gl.R_wc * Eigen::Vector3d(1, -1, -1).asDiagonal();
    std::string rows = row_major(gl, 4);
    std::ranges::replace(rows, ' ', ',');
    std::string nested;
    const auto cells = split(rows, ',');
    for (int row = 0; row < 4; ++row)
      nested += fmt::format("{}[{}]",
                            row > 0 ? "," : "",
                            fmt::join(cells.begin() + 4 * row, cells.begin() + 4 * row + 4, ","));
    frames +=
        fmt::format(R"({}{{"file_path": "images/frame_{:05d}.png", "transform_matrix": [{}]}})",
                    i > 0 ? "," : "",
                    i,
                    nested);
  }
  folder.write("transforms.json",
               R"({"fl_x": 60, "fl_y": 61, "cx": 31.5, "cy": 23.5, "w": 64, "h": 48, "frames": [)" +
                   frames + "]}");
  const auto recording = open();
  EXPECT_EQ(recording->camera.cx, 31);
  expect_true_poses(*recording);
}

/// Files of a phone, whose frames are 0.1 s apart. Poses have x right, y up and z backward.
struct PhoneLog {
  explicit PhoneLog(double first_s, const char* lens, const char* force) {
    for (int i = 0; i < kFramesOfASet; ++i) {
      const double time_s = first_s + 0.1 * i;
      images.push_back(color_image(i));
      frames += fmt::format("{:.3f},{}{}\n", time_s, i, lens);
      const auto& [R_wc, p] = true_pose(i);
      const Eigen::Quaterniond q(R_wc * Eigen::Vector3d(1, -1, -1).asDiagonal());
      const auto turn = {q.w(), q.x(), q.y(), q.z()};
      poses += fmt::format("{:.3f},{},{}\n", time_s, fmt::join(p, ","), fmt::join(turn, ","));
    }
    for (int i = 0; i < 100; ++i) {
      rates += fmt::format("{:.3f},0.1,0.2,0.3\n", first_s - 0.1 + 0.01 * i);
      if (i == 7) rates += "1,0,0,0\n";  // iOS delivers some twice
      forces += fmt::format("{:.3f},{}\n", first_s - 0.1 + 0.01 * i, force);
    }
  }
  std::vector<cv::Mat> images;
  std::string frames, rates, forces, poses;
};

TEST_F(DataSets, ReadsAnIosLog) {
  const PhoneLog log(5000, ",60,61,31,23", "0,-1,0");
  make_video(folder.path() / "Frames.mp4", log.images);
  folder.write("Frames.txt", log.frames);
  folder.write("Gyro.txt", log.rates);
  folder.write("Accel.txt", log.forces);
  folder.write("ARposes.txt", log.poses);
  const auto recording = open();
  EXPECT_EQ(recording->timestamps_ns[1], 5000'100'000'000);
  EXPECT_EQ(recording->camera.fx, 60);
  EXPECT_EQ(recording->camera_source, CameraSource::file);
  expect_true_poses(*recording);
  ASSERT_TRUE(recording->gyroscope);
  // The rear camera's x points to the phone's bottom.
  EXPECT_TRUE((recording->gyroscope->R_gyro_camera * Eigen::Vector3d::UnitX())
                  .isApprox(-Eigen::Vector3d::UnitY()));
  // An upright phone at rest.
  EXPECT_TRUE(recording->gyroscope->accelerations_m_s2.at(50).isApprox(
      Eigen::Vector3d(0, 9.80665, 0), 1e-9));
  folder.write("Gyro.txt", log.rates + "5001.5,nan,0,0\n");
  folder.write("ARposes.txt", log.poses + "5001.5,nan,0,0,1,0,0,0\n");
  EXPECT_THAT(open()->notes, Contains(HasSubstr("Gyro.txt: 1 sample left out")));
  EXPECT_THAT(open()->notes, Contains(HasSubstr("ARposes.txt: 1 pose left out")));
}

/// The data set's calibration by Kalibr: the camera of an upright phone has its x axis.
TEST_F(DataSets, ReadsAdviosPosesAndSensorsInThePhonesAxes) {
  const PhoneLog log(12, "", "0.1,9.7,0.5");
  folder.write("iphone/frames.csv", log.frames);
  folder.write("iphone/gyro.csv", log.rates);
  folder.write("iphone/accelerometer.csv", log.forces);
  folder.write("ground-truth/pose.csv", log.poses);
  make_video(folder.path() / "iphone/frames.mov", log.images, {.clockwise_degrees = 90});
  const auto recording = open_recording(folder.path() / "iphone");
  EXPECT_EQ(recording->timestamps_ns[1], 12'100'000'000);
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_EQ(recording->camera.height, 64);
  expect_true_poses(*recording, 1e-6);
  const Gyroscope& gyroscope = recording->gyroscope.value();
  const Eigen::Matrix3d expected = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_TRUE(gyroscope.R_gyro_camera.isApprox(expected, 1e-9)) << gyroscope.R_gyro_camera;
  EXPECT_TRUE(gyroscope.accelerations_m_s2.at(50).isApprox(Eigen::Vector3d(0.1, 9.7, 0.5), 1e-9));
}

TEST_F(DataSets, GuessesTheLensOfTumWithoutACalibration) {
  write_images("rgb/{}.png");
  std::string list;
  for (int i = 0; i < kFramesOfASet; ++i) list += fmt::format("{}.5 rgb/{}.png\n", 1000 + i, i);
  folder.write("rgb.txt", list);
  const auto recording = open();
  EXPECT_EQ(recording->layout, "TUM RGB-D");
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  folder.write("calibration.txt", "60 61 31 23\n");
  EXPECT_EQ(open()->camera.fx, 60);
}

TEST_F(DataSets, NeedASizeForTracksWithoutImages) {
  folder.write("rgb.txt", "1000.5 rgb/0.png\n1001.5 rgb/1.png\n");
  folder.write("tracks.csv", "frame,track,x,y\n0,1,2,3\n1,1,2,4\n");
  const OpenOptions options{.tracks = folder.path() / "tracks.csv"};
  const auto error = [&] { return error_of([&] { open_recording(folder.path(), options); }); };
  EXPECT_THAT(error(), HasSubstr("camera.yaml: key `image_width`: found no value"));
  folder.write("calibration.txt", "60 61 31 23\n");
  EXPECT_THAT(error(), HasSubstr("calibration.txt: key `image_width`: found no value"));
}

TEST_F(DataSets, ReportPosesThatDoNotFitTheImages) {
  write_images("results/frame{:06d}.jpg");
  folder.write("traj.txt", row_major(true_pose(0), 4) + "\n");
  const auto recording = open();
  EXPECT_FALSE(recording->truth);
  EXPECT_THAT(recording->notes,
              Contains("no ground truth from Replica: " + file("traj.txt") +
                       ": found 1 pose, expected 5, one for each image"));
}

TEST_F(DataSets, NeverReadDepthAsAnImage) {
  write_images("depth{:06d}.png", true);
  EXPECT_THAT(error(), HasSubstr("found no recording"));
  write_images("left{:06d}.png");
  write_images("right{:06d}.png");
  const auto recording = open();
  EXPECT_EQ(recording->frame_count(), kFramesOfASet);
  EXPECT_THAT(recording->image_files.front().string(), HasSubstr("left000000.png"));
}

TEST_F(DataSets, InfoListsWhatWasReadAndWhatWasNot) {
  write_images("frame-{:06d}.color.png");
  write_images("frame-{:06d}.depth.png", true);
  folder.write("camera.yaml", kCameraYaml);
  folder.write("notes.md", "my notes");
  const auto recording = open();
  const RecordingInfo info = describe(*recording);
  const std::string text = to_text(info);
  EXPECT_THAT(text, HasSubstr("files         frame-000000.color.png: 5 images\n"));
  EXPECT_THAT(text, HasSubstr("              camera.yaml: calibration (EuRoC)\n"));
  EXPECT_THAT(text,
              HasSubstr("              frame-000000.depth.png: not read, 5 images: depth, by its "
                        "name\n"));
  EXPECT_THAT(text,
              HasSubstr("              notes.md: not read, not a file that this layout reads"));
  const auto json = to_json(info)["files"];
  ASSERT_EQ(json.size(), 4U);
  EXPECT_EQ(json[1]["use"], "calibration (EuRoC)");
  EXPECT_EQ(json[2]["read"], false);
}

std::filesystem::path layout_case(const char* name) {
  return std::filesystem::path(GPO_SOURCE_DIR) / "../shared/data/cases/dataset-layouts" / name;
}

struct LayoutCase {
  const char* folder;
  bool calibrated, truth;
};

class LayoutCases : public testing::TestWithParam<LayoutCase> {};
INSTANTIATE_TEST_SUITE_P(Cases,
                         LayoutCases,
                         testing::Values(LayoutCase{"kitti/sequences/00", true, true},
                                         LayoutCase{"7scenes/seq-01", false, true},
                                         LayoutCase{"replica", true, true},
                                         LayoutCase{"eth3d", true, true},
                                         LayoutCase{"colmap", true, true}));

TEST_P(LayoutCases, OpenWithLensAndPoses) {
  const auto [name, calibrated, truth] = GetParam();
  const auto folder = layout_case(name);
  if (!is_folder(folder)) GTEST_SKIP() << folder << " is missing";
  const auto recording = open_recording(folder);
  EXPECT_EQ(recording->frame_count(), 16);
  EXPECT_EQ(recording->camera_source, calibrated ? CameraSource::file : CameraSource::guess);
  if (calibrated) {
    EXPECT_NEAR(recording->camera.fx, 500, 1e-9);
    EXPECT_NEAR(recording->camera.cx, 322.5, 1e-9);
    EXPECT_NEAR(recording->camera.cy, 237.5, 1e-9);
  }
  ASSERT_EQ(recording->truth.has_value(), truth);
  // The second camera in the first one's frame, as in made-by/layouts.py.
  const Pose T = inverse(*recording->truth->poses[0]) * *recording->truth->poses[1];
  EXPECT_TRUE(T.p_wc.isApprox(Eigen::Vector3d(0.0177214804, -0.00409180998, -0.00856527859), 2e-3))
      << T.p_wc.transpose();
}

TEST(LayoutCases, OpenAnIosLog) {
  const auto given = layout_case("ios-logger");
  if (!is_folder(given)) GTEST_SKIP() << given << " is missing";
  const TestFolder folder;
  for (const char* name : {"Frames.txt", "Gyro.txt", "Accel.txt"})
    std::filesystem::copy(given / name, folder.path());
  std::filesystem::copy_file(given / "Frames.m4v", folder.path() / "Frames.mp4");
  const auto recording = open_recording(folder.path());
  EXPECT_EQ(recording->frame_count(), 16);
  EXPECT_EQ(recording->camera.cx, 322.5);
  EXPECT_EQ(recording->timestamps_ns[1], 5000'033'333'000);
  EXPECT_TRUE(recording->gyroscope);
}

TEST_F(DataSets, ConvertedLensesStayTheSameInEveryFormat) {
  using enum Distortion;
  write_images("{}.png");
  folder.write("camera.yaml", kCameraYaml);
  Recording recording = *open();
  for (const auto& [distortion, coefficients] :
       {std::pair(double_sphere, std::vector{-0.24, 0.57}),
        {extended_unified, {0.6, 1.1}},
        {omnidirectional, {2.0443, -0.116, 0.453, -3.7e-4, 0}},
        {field_of_view, {0.9207}},
        {thin_prism_fisheye, {0.1, 0.2, 1e-3, 2e-3, 0.3, 0.4, 1e-3, 1.0 / 3000}}}) {
    recording.camera.distortion = distortion;
    recording.camera.coefficients = coefficients;
    recording.camera.fx = 180.0 / 7;
    for (const auto& [format, name] : {std::pair(RecordingFormat::euroc, "euroc"),
                                       std::pair(RecordingFormat::rosbag, "bag/a.bag"),
                                       std::pair(RecordingFormat::mcap, "mcap/a.mcap")}) {
      const auto output = folder.path() / lens_model(distortion).name / name;
      write_recording(recording, {}, format, output);
      EXPECT_EQ(open_recording(output)->camera, recording.camera) << output;
    }
  }
}

}  // namespace
}  // namespace gpo::test
