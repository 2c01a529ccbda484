// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/recording/recording_folder.h"

namespace gpo::test {
namespace {

using testing::Contains, testing::ElementsAre, testing::Field, testing::HasSubstr, testing::IsEmpty,
    testing::Not;

constexpr const char* kOrbSlamText =
    "%YAML:1.0\nCamera.type: \"PinHole\"\nCamera1.fx: 458.654\nCamera1.fy: 457.296\n"
    "Camera1.cx: 367.215\nCamera1.cy: 248.375\nCamera1.k1: -0.28340811\n"
    "Camera1.k2: 0.07395907\nCamera1.p1: 0.00019359\nCamera1.p2: 1.76187114e-05\n"
    "Camera.width: 752\nCamera.height: 480\nCamera.fps: 20\n";
constexpr const char* kKalibrText =
    "cam0:\n  camera_model: pinhole\n  distortion_coeffs: [0.9207]\n  distortion_model: fov\n"
    "  intrinsics: [380.1, 379.8, 367.2, 248.4]\n  resolution: [752, 480]\n";
constexpr const char* kMeiText =
    "%YAML:1.0\n---\nmodel_type: MEI\nimage_width: 752\nimage_height: 480\n"
    "mirror_parameters:\n   xi: 3.6313355285286337e+00\ndistortion_parameters:\n"
    "   k1: 6.5586e-01\n   k2: -2.8127e-01\n   p1: 1.5e-03\n   p2: 9.4e-05\n"
    "projection_parameters:\n   gamma1: 7.2e+02\n   gamma2: 7.2e+02\n   u0: 3.76e+02\n"
    "   v0: 2.41e+02\n";
/// The camera's x is the body's y.
constexpr const char* kBodyCamera =
    "[0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975, 0.999557249008, "
    "0.0149672133247, 0.025715529948, -0.064676986768, -0.0257744366974, 0.00375618835797, "
    "0.999660727178, 0.00981073058949, 0, 0, 0, 1]";

class CalibrationBesideImages : public RecordingFolder {
 protected:
  CalibrationBesideImages() {
    for (int i = 0; i < 3; ++i)
      folder.write("img" + std::to_string(i) + ".png", cv::Mat(480, 752, CV_8UC1, cv::Scalar(i)));
  }
};

TEST_F(CalibrationBesideImages, IsFoundByItsKeys) {
  folder.write("anything.yaml", kOrbSlamText);
  const auto recording = open();
  EXPECT_EQ(recording->camera_source, CameraSource::file);
  EXPECT_EQ(recording->camera.fx, 458.654);
  EXPECT_EQ(recording->files.front().use, "calibration (ORB-SLAM)");
}

TEST_F(CalibrationBesideImages, MayHaveAnEndingInUpperCase) {
  for (const char* name : {"Camera.YAML", "CALIB.YML", "desk-CAMCHAIN.Yaml", "settings.YAML"}) {
    const auto file = folder.write(name, kKalibrText);
    EXPECT_EQ(search_calibration({folder.path()}).file, file);
    EXPECT_EQ(open()->camera_source, CameraSource::file) << name;
    std::filesystem::remove(file);
  }
  folder.write("a.yaml", kOrbSlamText);
  const auto usual = folder.write("Camera.YAML", kKalibrText);
  EXPECT_EQ(search_calibration({folder.path()}).file, usual);
}

/// The configuration has the extrinsics and the time offset, whatever the files' names.
TEST_F(CalibrationBesideImages, IsVinsFusionsConfigurationAndNotTheCameraItNames) {
  const std::string config =
      "%YAML:1.0\nimage_width: 752\nbody_T_cam0: !!opencv-matrix\n   rows: 4\n   cols: 4\n"
      "   dt: d\n   data: " +
      std::string(kBodyCamera) + "\ntd: -0.002\ncam0_calib: ";
  for (const char* camera : {"cam0_pinhole.yaml", "zcam0_pinhole.yaml", "camera.yaml"}) {
    const auto lens = folder.write(camera, kMeiText);
    const auto file = folder.write("euroc_mono_imu_config.yaml", config + camera + "\n");
    const auto recording = open();
    EXPECT_EQ(search_calibration({folder.path()}).file, file) << camera;
    ASSERT_TRUE(recording->T_body_camera) << camera;
    EXPECT_GT(recording->T_body_camera->R_wc(1, 0), 0.99);
    EXPECT_THAT(recording->files,
                Contains(Field(&FoundFile::use, "camera of euroc_mono_imu_config.yaml")))
        << camera;
    EXPECT_THAT(recording->notes, Not(Contains(HasSubstr("not read")))) << camera;
    std::filesystem::remove(lens);
  }
}

TEST_F(CalibrationBesideImages, IsNamedWithTheReasonIfItIsNotRead) {
  std::string broken = kOrbSlamText;
  broken.replace(broken.find("Camera1.fy"), 10, "Camera1.fz");
  folder.write("settings.yaml", broken);
  folder.write("calib.npz", "binary");
  const auto recording = open();
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_THAT(
      recording->notes,
      testing::IsSupersetOf(
          {"settings.yaml looks like a calibration and is not read: key `Camera1.fy`: found "
           "no value, expected a number",
           "calib.npz looks like a calibration and is not read: not a format that is "
           "read"}));
}

/// The text that ROS' camera_calibration writes.
std::string ros_text(const std::string& coefficients) {
  return "# oST version 5.0 parameters\n\n\n[image]\n\nwidth\n752\n\nheight\n480\n\n"
         "[narrow_stereo]\n\ncamera matrix\n458.654000 0.000000 367.215000\n"
         "0.000000 457.296000 248.375000\n0.000000 0.000000 1.000000\n\ndistortion\n" +
         coefficients +
         "\n\nrectification\n1.000000 0.000000 0.000000\n0.000000 1.000000 0.000000\n"
         "0.000000 0.000000 1.000000\n\nprojection\n450.1 0.0 366.0 0.0\n0.0 450.2 248.0 0.0\n"
         "0.000000 0.000000 1.000000 0.000000\n\n";
}

TEST_F(CalibrationBesideImages, IsRosTextOfAnyName) {
  const std::string text = ros_text("-0.28 0.07 0.0002 0.00002 0.0");
  const Calibration named = read_calibration(folder.write("camera.ini", text));
  EXPECT_EQ(named.format, "ROS");
  std::filesystem::rename(folder.path() / "camera.ini", folder.path() / "ost.txt");
  const auto recording = open();
  EXPECT_EQ(recording->camera, named.camera);
  EXPECT_EQ(recording->camera.fy, 457.296);
  EXPECT_EQ(recording->camera.cx, 367.215);
  EXPECT_EQ(recording->camera_source, CameraSource::file);
  EXPECT_EQ(recording->camera.width, 752);
  EXPECT_THAT(recording->camera.coefficients, ElementsAre(-0.28, 0.07, 0.0002, 0.00002, 0));
  folder.write("ost.txt", ros_text("0.1 0.2 0.3 0.4"));
  EXPECT_THAT(open()->notes,
              Contains("ost.txt looks like a calibration and is not read: key "
                       "`distortion`: found 4 numbers, expected 5 or 8 of a lens that is "
                       "no fisheye. Use the YAML file of the calibration"));
  folder.write("ost.txt", ros_text("0.1 0 0 0 0") + ros_text("0.1 0 0 0 0"));
  EXPECT_THAT(open()->notes, Contains(HasSubstr("found 2 cameras, expected one camera")));
}

TEST_F(CalibrationBesideImages, IsNamedIfATextHasItsWords) {
  folder.write("setup.txt", "Focal length in pixels 500\n");
  EXPECT_THAT(open()->notes,
              Contains(HasSubstr("setup.txt looks like a calibration and is not read")));
}

TEST_F(CalibrationBesideImages, IgnoresOtherFiles) {
  folder.write("readme.txt", "The focal length is in camera.yaml.\n");
  folder.write("notes.yaml", "author: me\n");
  folder.write("list.txt", "1 2 3\n");
  folder.write("plane.yaml", "normal: [0, 0, 1]\ndistance: 1\n");
  const auto recording = open();
  EXPECT_EQ(recording->camera_source, CameraSource::guess);
  EXPECT_THAT(recording->files, IsEmpty());
}

}  // namespace
}  // namespace gpo::test
