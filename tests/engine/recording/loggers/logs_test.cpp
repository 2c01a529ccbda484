// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/logs.h"

#include "tests/engine/recording/images/made_video.h"
#include "tests/engine/recording/recording_folder.h"

namespace gpo::test {
namespace {

using testing::Contains, testing::ElementsAre, testing::HasSubstr;

/// Beginning of the documentation's example.
const std::string kGcsv =
    "GYROFLOW IMU LOG\nversion,1.3\nid,custom_logger_name\norientation,YxZ\n"
    "note,development_test\nfwversion,FIRMWARE_0.1.0\ntimestamp,1644159993\nvendor,potatocam\n"
    "videofilename,videofilename.mp4\nlensprofile,potatocam/potatocam_mark1_prime_7_5mm_4k\n"
    "lens_info,wide\nframe_readout_time,15.23\nframe_readout_direction,0\ntscale,0.001\n"
    "gscale,0.00122173047\nascale,0.00048828125\nt,gx,gy,gz,ax,ay,az\n"
    "0,39,86,183,-1137,-15689,-2986\n1,56,100,202,-1179,-15694,-2887\n"
    "2,63,108,218,-1247,-15702,-2794\n";

const std::string kOdometry =
    "timestamp, frame, x, y, z, qx, qy, qz, qw\n"
    "1000.5, 000000, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0\n"
    "1000.6, 000001, 0.5, -0.25, 0.0, 0.70710678, 0.0, 0.0, 0.70710678\n"
    "1000.7, 000002, 1.0, 0.0, 0.125, 0.0, 0.0, 0.0, 1.0\n";
const std::string kMatrix = "61.5, 0.0, 32.25\n0.0, 61.25, 24.5\n0.0, 0.0, 1.0";
const std::string kImu =
    "timestamp, a_x, a_y, a_z, alpha_x, alpha_y, alpha_z\n"
    "1000.49, 0.1, 0.2, -0.9, 0.01, 0.02, 0.03\n1000.50, 0.1, 0.2, -0.9, 0.04, 0.05, 0.06\n";

const std::string kLoggedFrames =
    R"({"sensor":{"type":"accelerometer","values":[-0.038,9.12,-2.98]},"time":5.0}
{"sensor":{"type":"gyroscope","values":[0.3,0.2,0.1]},"time":5.02}
{"sensor":{"type":"gyroscope","values":[0.003,-0.17,0.016]},"time":5.01}
{"frames":[{"cameraInd":0}],"number":0,"time":5.0}
{"frames":[{"cameraInd":0}],"number":1,"time":5.1}
{"frames":[{"cameraInd":0}],"number":2,"time":5.25}
)";
const std::string kSpectacular = R"({"cameras": [{"distortionCoefficients": [0.1, 0.01, 0.001],
"focalLengthX": 60.5, "focalLengthY": 60.25, "principalPointX": 31.5, "principalPointY": 23.5,
"imuToCamera": [[0, -1, 0, 0.1], [-1, 0, 0, 0.2], [0, 0, -1, 0.3], [0, 0, 0, 1]],
"model": "pinhole", "imageWidth": 64, "imageHeight": 48}]}
)";

class LoggedVideo : public RecordingFolder {
 protected:
  void video(const std::string& name, bool with_calibration) const {
    if (with_calibration) folder.write("camera.yaml", kCameraYaml);
    make_video(folder.path() / name,
               std::vector<cv::Mat>(3, cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(90))));
  }
};

TEST(SignedAxes, AcceptOnlyRotations) {
  const Eigen::Vector3d turned = *signed_axes("YxZ") * Eigen::Vector3d(1, 2, 3);
  EXPECT_EQ(turned, Eigen::Vector3d(2, -1, 3));
  for (const char* bad : {"YXZ", "XXZ", "XY", "XYZW", "xyz", "XYQ", ""})
    EXPECT_FALSE(signed_axes(bad)) << bad;
}

TEST_F(LoggedVideo, ReadsGyroflowsRatesAxesAndReadout) {
  video("GX01.mp4", true);
  folder.write("GX01.gcsv", kGcsv);
  const auto recording = open();
  ASSERT_TRUE(recording->gyroscope);
  const Gyroscope& gyroscope = *recording->gyroscope;
  EXPECT_THAT(gyroscope.timestamps_ns, ElementsAre(0, 1'000'000, 2'000'000));
  const Eigen::Vector3d rates = 0.00122173047 * Eigen::Vector3d(56, 100, 202);
  EXPECT_LT((gyroscope.rates_rad_s[1] - rates).norm(), 1e-12);
  // Gyroflow's documented axes up, left, back are y, -x, z of the log.
  const Eigen::Vector3d camera = gyroscope.R_gyro_camera.transpose() * rates;
  EXPECT_LT((camera - Eigen::Vector3d(rates.x(), -rates.y(), -rates.z())).norm(), 1e-12);
  EXPECT_EQ(recording->camera.readout, readout_of(1e-3 * 15.23));
  EXPECT_EQ(gyroscope.lines[0], 18);
}

TEST_F(LoggedVideo, TakesTheReadoutDirectionFromGyroflowUnlessTheCalibrationHasOne) {
  video("GX01.mp4", true);
  const auto camera_with = [&](char direction) {
    std::string log = kGcsv;
    const std::string key = "frame_readout_direction,";
    log[log.find(key) + key.size()] = direction;
    folder.write("GX01.gcsv", log);
    return open()->camera;
  };
  EXPECT_EQ(camera_with('0').readout_direction, std::nullopt);
  EXPECT_EQ(camera_with('1').readout, readout_of(-1e-3 * 15.23));
  EXPECT_EQ(camera_with('2').readout_direction, ReadoutDirection::right);
  EXPECT_EQ(camera_with('3').readout_direction, ReadoutDirection::left);
  EXPECT_EQ(camera_with('3').readout, readout_of(1e-3 * 15.23));
  folder.write("camera.yaml", std::string(test::kCameraYaml) + "readout_direction: up\n");
  EXPECT_EQ(camera_with('3').readout_direction, ReadoutDirection::up);
}

TEST(Gcsv, NamesLinesOfErrors) {
  const std::string table = "GYROFLOW IMU LOG\ntscale,1\ngscale,1\nt,gx,gy,gz\n";
  const std::vector<Refusal> refusals = {
      {"time,x,y\n", ":1: found a different first line, expected GYROFLOW IMU LOG"},
      {"", ":1: found a different first line, expected GYROFLOW IMU LOG"},
      {"GYROFLOW IMU LOG\nversion,1\n", ":3: found no table, expected a line t,gx,gy,gz"},
      {table, ":4: found no rows, expected t,gx,gy,gz"},
      {"GYROFLOW IMU LOG\ngscale,1\nt,gx,gy,gz\n0,1,2,3\n",
       ":3: found no tscale above the table, expected tscale,NUMBER, > 0"},
      {"GYROFLOW IMU LOG\ntscale,1\ngscale,x\nt,gx,gy,gz\n0,1,2,3\n",
       ":3: found no number, expected gscale,NUMBER"},
      {"GYROFLOW IMU LOG\norientation,XYz\ntscale,1\ngscale,1\nt,gx,gy,gz\n0,1,2,3\n",
       ":2: found invalid axes, expected orientation,AXES with three right-handed axes such as "
       "YxZ"},
      {table + "0,1,2\n", ":5: found fewer than 4 columns, expected t,gx,gy,gz"},
      {table + "0,1,2,3\n0,1,2,3\n",
       ":6: found a time that is not later than the previous one, expected ascending times"},
      {"GYROFLOW IMU LOG\ntscale,1\ngscale,1e300\nt,gx,gy,gz\n0,1e300,2,3\n",
       ":5: found a rate that is not finite, expected numbers"},
      {table + "0,1,nan,3\n", ":5: found no row of finite numbers, expected some"}};
  expect_refusals("a.gcsv", refusals, [](const auto& file) { read_gcsv(file); });
}

TEST_F(LoggedVideo, ReadsSensorLoggersRatesByName) {
  video("a.mp4", true);
  folder.write("Gyroscope.csv",
               "time,seconds_elapsed,z,y,x\n1698501144401773000,0.25,0.3,0.2,0.1\n"
               "1698501144411773000,0.26,0.6,0.5,0.4\n");
  const auto recording = open();
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_THAT(recording->gyroscope->timestamps_ns, ElementsAre(250'000'000, 260'000'000));
  EXPECT_EQ(recording->gyroscope->rates_rad_s[0], Eigen::Vector3d(0.1, 0.2, 0.3));
  // With the phone upright, its x (right) is the sensor's -y.
  EXPECT_LT((recording->gyroscope->R_gyro_camera.col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_THAT(recording->notes, Contains(HasSubstr("assuming that its elapsed seconds")));
}

TEST_F(LoggedVideo, RefusesSensorLoggerWithOtherColumns) {
  video("a.mp4", true);
  folder.write("Gyroscope.csv", "time,seconds_elapsed,z,y\n1,0.25,0.3,0.2\n");
  EXPECT_EQ(error(), file("Gyroscope.csv") + ": missing column \"x\"");
  folder.write("Gyroscope.csv", "time,seconds_elapsed,z,y,x\n1,0.25,0.3,0.2,1\n2,0.25,1,1,1\n");
  EXPECT_EQ(
      error(),
      file("Gyroscope.csv") +
          ":3: found a time that is not later than the previous one, expected ascending times");
}

TEST_F(LoggedVideo, ReadsStrayScannersCalibrationAndTruth) {
  video("rgb.mp4", false);
  folder.write("odometry.csv", kOdometry);
  folder.write("camera_matrix.csv", kMatrix);
  folder.write("imu.csv", kImu);
  const auto recording = open();
  EXPECT_EQ(recording->camera.fx, 61.5);
  EXPECT_EQ(recording->camera.cy, 24.5);
  EXPECT_EQ(recording->camera.width, 64);
  EXPECT_EQ(recording->timestamps_ns[1], 1'000'600'000'000);
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_EQ(recording->gyroscope->timestamps_ns[0], 1'000'490'000'000);
  EXPECT_EQ(recording->gyroscope->rates_rad_s[1], Eigen::Vector3d(0.04, 0.05, 0.06));
  // The screen points up.
  EXPECT_TRUE(recording->gyroscope->accelerations_m_s2.at(1).isApprox(
      -9.80665 * Eigen::Vector3d(0.1, 0.2, -0.9), 1e-9));
  ASSERT_TRUE(recording->truth);
  EXPECT_EQ(recording->truth->source, "odometry.csv");
  ASSERT_EQ(recording->truth->poses.size(), 3U);
  EXPECT_EQ(recording->truth->poses[1]->p_wc, Eigen::Vector3d(0.5, -0.25, 0));
  EXPECT_NEAR(recording->truth->poses[1]->R_wc(2, 1), 1, 1e-6) << "a quarter about x";
}

TEST_F(LoggedVideo, RefusesBrokenStrayScanner) {
  video("rgb.mp4", false);
  folder.write("odometry.csv", kOdometry);
  folder.write("camera_matrix.csv", "61.5, 0.0, 32.25\n0.0, 61.25, 24.5\n");
  EXPECT_EQ(error(),
            file("camera_matrix.csv") +
                ":2: found a matrix of another form, expected 3 rows: fx 0 cx, 0 fy cy, 0 0 1");
  folder.write("camera_matrix.csv", kMatrix);
  folder.write("odometry.csv", kOdometry.substr(0, kOdometry.find("1000.7")));
  EXPECT_EQ(error(), file("odometry.csv") + ": found 2 frames, expected 3, one for each image");
}

TEST_F(LoggedVideo, ReadsSpectacularAisCalibrationClockAndAxes) {
  video("data.mp4", false);
  video("data2.mp4", false);  // a second camera
  folder.write("data.jsonl", kLoggedFrames);
  folder.write("calibration.json", kSpectacular);
  const auto recording = open();
  EXPECT_EQ(recording->camera.fx, 60.5);
  EXPECT_EQ(recording->camera.distortion, Distortion::radial_tangential);
  EXPECT_THAT(recording->camera.coefficients, ElementsAre(0.1, 0.01, 0, 0, 0.001));
  EXPECT_THAT(recording->timestamps_ns, ElementsAre(5'000'000'000, 5'100'000'000, 5'250'000'000));
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_THAT(recording->gyroscope->timestamps_ns, ElementsAre(5'010'000'000, 5'020'000'000));
  EXPECT_EQ(recording->gyroscope->rates_rad_s[1], Eigen::Vector3d(0.3, 0.2, 0.1));
  EXPECT_EQ(recording->gyroscope->lines[1], 2);
  // imuToCamera maps the gyroscope's x to the camera's -y.
  EXPECT_LT((recording->gyroscope->R_gyro_camera.col(1) + Eigen::Vector3d::UnitX()).norm(), 1e-12);
}

TEST_F(LoggedVideo, IgnoresOtherFilesNamedDataJsonl) {
  video("clip.mp4", true);
  folder.write("data.jsonl", "[]\n");
  EXPECT_FALSE(open()->gyroscope);
}

TEST(Spectacular, NamesLinesOfErrors) {
  const std::vector<Refusal> refusals = {
      {"{}\n[1]\n", ":2: found a line that is not a JSON object, expected one measurement"},
      {"{\"sensor\"", ":1: found a line that is not a JSON object, expected one measurement"},
      {std::string(3000, '[') + "\n",
       ":1: found a line that is not a JSON object, expected one measurement"},
      {std::string(70'000, 'x'), ":1: found a line of 70000 bytes, expected one measurement"},
      {R"({"sensor":{"type":"gyroscope","values":[1,2]},"time":1})",
       ":1: found 2 rates, expected 3 (rad/s)"},
      {R"({"sensor":{"type":"gyroscope","values":[1,2,null]},"time":1})",
       ":1: found no finite number under `values`, expected one"},
      {R"({"sensor":{"type":"gyroscope","values":[1,2,3]},"time":1e30})",
       ":1: found an implausible `time`, expected seconds"},
      {R"({"sensor":{"type":"gyroscope","values":[1,2,3]}})",
       ":1: found no finite number under `time`, expected one"},
      {"{\"frames\":[],\"time\":1}\n{\"frames\":[],\"time\":1}\n",
       ":2: found a frame that is not later than the previous one, expected ascending times"},
      {R"({"frames":[{"cameraParameters":{"focalLengthX":0,"focalLengthY":1,)"
       R"("principalPointX":1,"principalPointY":1}}],"time":1})",
       ":1: found an implausible focal length, expected pixels, > 0"},
      {R"({"frames":[{"cameraParameters":{"focalLengthX":1,"focalLengthY":1,)"
       R"("principalPointX":1,"principalPointY":1,"distortionModel":"MEI",)"
       R"("distortionCoefficients":[1]}}],"time":1})",
       ":1: found an unsupported lens with 1 coefficients, expected pinhole with 3, "
       "kannala-brandt4 with 4 or brown-conrady with 4, 5 or 8"}};
  expect_refusals("data.jsonl", refusals, [](const auto& file) { read_spectacular(file); });
}

}  // namespace
}  // namespace gpo::test