// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>
#include <opencv2/core/persistence.hpp>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::ElementsAre;
using testing::HasSubstr;

const char* const kEuroc = R"(%YAML:1.0
# General sensor definitions.
sensor_type: camera
comment: VI-Sensor cam0 (MT9M034)
T_BS:
  cols: 4
  rows: 4
  data: [0.0148655429818, -0.999880929698, 0.00414029679422, -0.0216401454975,
         0.999557249008, 0.0149672133247, 0.025715529948, -0.064676986768,
        -0.0257744366974, 0.00375618835797, 0.999660727178, 0.00981073058949,
         0.0, 0.0, 0.0, 1.0]
rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
)";

TEST(CalibrationFile, ReadsEurocsSensorFile) {
  const TestFolder folder;
  const auto calibration = read_calibration(folder.write("sensor.yaml", kEuroc));
  const Camera& camera = calibration.camera;
  EXPECT_EQ(camera.width, 752);
  EXPECT_EQ(camera.height, 480);
  EXPECT_DOUBLE_EQ(camera.fy, 457.296);
  EXPECT_DOUBLE_EQ(camera.cx, 367.215);
  EXPECT_EQ(camera.distortion, Distortion::radial_tangential);
  EXPECT_THAT(camera.coefficients,
              ElementsAre(-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05));
  ASSERT_TRUE(calibration.T_body_camera);
  const Pose& T = *calibration.T_body_camera;
  EXPECT_NEAR(T.R_wc(0, 1), -0.999880929698, 1e-8);
  EXPECT_TRUE((T.R_wc * T.R_wc.transpose()).isIdentity(1e-14));
  EXPECT_DOUBLE_EQ(T.p_wc.y(), -0.064676986768);
  EXPECT_EQ(calibration.rate_hz, 20);
  EXPECT_EQ(calibration.time_offset_ns, 0);
}

const cv::Mat kCameraMatrix =
    (cv::Mat_<double>(3, 3) << 533.25, 0, 341.5, 0, 534, 231.125, 0, 0, 1);

TEST(CalibrationFile, ReadsFileStorageInAllFormatsAndWithAllNames) {
  const TestFolder folder;
  const cv::Mat k =
      (cv::Mat_<double>(12, 1) << -0.29, 0.1, 1e-3, -2e-4, 0.013, 1, 2, 3, 4, 5, 6, 7);
  struct Names {
    const char *matrix, *coefficients;
  };
  for (const char* file : {"camera.xml", "camera.yaml", "camera.yml", "camera.json"}) {
    for (const auto& [matrix, coefficients] : {Names{"camera_matrix", "distortion_coefficients"},
                                               Names{"cameraMatrix", "distCoeffs"},
                                               Names{"Camera_Matrix", "Distortion_Coefficients"},
                                               Names{"K", "D"}}) {
      SCOPED_TRACE(std::string(file) + " " + matrix);
      {
        cv::FileStorage storage((folder.path() / file).string(), cv::FileStorage::WRITE);
        storage << "calibration_time"
                << "Thu 01 Jan 2026 <12:00>"
                << "flags" << 0 << matrix << kCameraMatrix << coefficients << k
                << "avg_reprojection_error" << 0.19;
        if (coefficients == std::string("D"))
          storage << "image_width" << 640 << "image_height" << 480;
        else
          storage << "image_size" << cv::Size(640, 480);
      }
      const Camera camera = read_calibration(folder.path() / file).camera;
      EXPECT_EQ(camera.width, 640);
      EXPECT_EQ(camera.height, 480);
      EXPECT_DOUBLE_EQ(camera.fx, 533.25);
      EXPECT_DOUBLE_EQ(camera.fy, 534);
      EXPECT_DOUBLE_EQ(camera.cx, 341.5);
      EXPECT_DOUBLE_EQ(camera.cy, 231.125);
      EXPECT_EQ(camera.distortion, Distortion::radial_tangential);
      EXPECT_THAT(camera.coefficients,
                  testing::Pointwise(testing::DoubleEq(), std::vector<double>(k)));
    }
  }
}

TEST(CalibrationFile, NamesTheLineOfBadXml) {
  const TestFolder folder;
  const auto message = [&](const std::string& content) {
    return error_of([&] { read_calibration(folder.write("camera.xml", content)); });
  };
  EXPECT_THAT(message("<?xml version=\"1.0\"?>\n<opencv_storage>\n<K>\n</opencv_storage>\n"),
              testing::AllOf(HasSubstr("camera.xml:"), HasSubstr("expected XML")));
  EXPECT_THAT(message(" <"), HasSubstr("expected XML"));
  EXPECT_THAT(message("<opencv_storage><K>1 2 3</K></opencv_storage>"),
              HasSubstr("camera.xml: key `K`: found 3 numbers, expected 9 (a 3x3 matrix)"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(message(deep), HasSubstr("expected XML"));
}

TEST(CalibrationFile, FindsUsualFileNames) {
  for (const char* name : {"camera.yaml",
                           "camera.yml",
                           "sensor.yaml",
                           "camchain-imucam.yaml",
                           "camchain-imucam-2026-01-01.yaml",
                           "desk-camchain.yaml",
                           "calibration.xml",
                           "out_camera_data.xml"}) {
    const TestFolder folder;
    folder.write("notes.yaml", "");
    EXPECT_THAT(error_of([&] { calibration_in(folder.path()); }),
                HasSubstr("found no calibration, expected camera.yaml"));
    folder.write(name, "");
    EXPECT_EQ(calibration_in(folder.path()), folder.path() / name);
  }
}

TEST(CalibrationFile, ReadsKalibrsChain) {
  const TestFolder folder;
  const auto calibration = read_calibration(folder.write("camera.yaml", R"(cam0:
  T_cam_imu:
  - [0.0, 1.0, 0.0, 0.1]
  - [-1.0, 0.0, 0.0, 0.2]
  - [0.0, 0.0, 1.0, 0.3]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: []
  camera_model: pinhole
  distortion_coeffs: [0.0034, 0.0007, -0.0020, 0.0002]
  distortion_model: equidistant
  intrinsics: [190.97, 190.97, 254.93, 256.89]
  resolution: [512, 512]
  rostopic: /cam0/image_raw
  timeshift_cam_imu: -0.0025
)"));
  EXPECT_EQ(calibration.camera.distortion, Distortion::equidistant);
  EXPECT_EQ(calibration.camera.coefficients.size(), 4U);
  EXPECT_EQ(calibration.time_offset_ns, -2500000);
  ASSERT_TRUE(calibration.T_body_camera);
  // The camera's -y is the IMU's x.
  const Pose& T = *calibration.T_body_camera;
  EXPECT_TRUE((T.R_wc * Eigen::Vector3d(0, -1, 0)).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(T.p_wc.isApprox(Eigen::Vector3d(0.2, -0.1, -0.3)));
}

TEST(CalibrationFile, ReadsTheLensUncertainty) {
  const TestFolder folder;
  const auto with_lines = [&](const std::string& lines) {
    return read_calibration(folder.write("sensor.yaml", kEuroc + lines)).camera.sigmas;
  };
  EXPECT_TRUE(with_lines("").empty());
  EXPECT_THAT(with_lines("intrinsics_sigma: [1, 2, 3, 4]\n"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(with_lines("intrinsics_sigma: [1, 2, 3, 4]\n"
                         "distortion_coefficients_sigma: [0.1, 0.2, 0, 0]\n"),
              ElementsAre(1, 2, 3, 4, 0.1, 0.2, 0, 0));
}

/// Returns the file with one line replaced.
std::string with(const std::string& key, const std::string& line) {
  std::string text = kEuroc;
  const std::size_t begin = text.find("\n" + key + ":") + 1;
  return text.replace(begin, text.find('\n', begin) - begin, line);
}

struct BadLine {
  const char* key;  ///< selects the replaced line; empty: `lines` are appended
  const char* lines;
  const char* message;  ///< behind the file's name
};

const std::vector<BadLine> kBadLines = {
    {"camera_model",
     "camera_model: omni",
     ":14: key `camera_model`: found \"omni\", expected pinhole"},
    {"distortion_model",
     "distortion_model: fov",
     ":16: key `distortion_model`: found \"fov\", expected radial-tangential, equidistant "
     "or none"},
    {"distortion_model",
     "distortion_model: none",
     ":17: key `distortion_coefficients`: found 4 numbers, expected none for distortion "
     "model none"},
    {"distortion_coefficients",
     "distortion_coefficients: [1, 2, 3]",
     ":17: key `distortion_coefficients`: found 3 numbers, expected 4, 5, 8, 12 or 14 (k1, "
     "k2, "
     "p1, p2, k3, ...) for distortion model radial-tangential"},
    {"distortion_coefficients",
     "distortion_coefficients: [1, 2, .nan, 4]",
     ":17: key `distortion_coefficients`: found \".nan\", expected finite numbers"},
    {"distortion_coefficients",
     "",
     ": key `distortion_coefficients`: found no value, expected a list of numbers"},
    {"intrinsics",
     "intrinsics: [458, 457, 367]",
     ":15: key `intrinsics`: found 3 numbers, expected 4 (fx, fy, cx, cy)"},
    {"intrinsics",
     "intrinsics: [458, -457, 367, 248]",
     ":15: key `intrinsics`: found 458, -457, expected plausible fx, fy > 0 in pixels"},
    {"intrinsics",
     "intrinsics: [458, 457, 367, 9000]",
     ":15: key `intrinsics`: found 367, 9000, expected cx, cy in pixels, near the image "
     "center"},
    {"intrinsics", "", ": key `intrinsics`: found no value, expected [fx, fy, cx, cy]"},
    {"resolution",
     "resolution: [752.5, 480]",
     ":13: key `resolution`: found 752.5x480, expected [width, height] in pixels"},
    {"resolution",
     "resolution: 752x480",
     ":13: key `resolution`: found \"752x480\", expected a list of numbers"},
    {"",
     "intrinsics_sigma: [1, 2]",
     ":18: key `intrinsics_sigma`: found 2 numbers, expected 4 (of fx, fy, cx, cy)"},
    {"",
     "intrinsics_sigma: [1, -2, 3, 4]",
     ":18: key `intrinsics_sigma`: found an implausible standard deviation, expected "
     "numbers "
     "from 0 on"},
    {"",
     "intrinsics_sigma: [1, 2, 3, 4]\ndistortion_coefficients_sigma: [0.1]",
     ":19: key `distortion_coefficients_sigma`: found 1 number, expected one for each of "
     "the "
     "distortion coefficients"},
    {"rate_hz",
     "rate_hz: 0",
     ":12: key `rate_hz`: found \"0\", expected 0.01 to 100000 images per second"},
    {"rate_hz",
     "rate_hz: 1e10",
     ":12: key `rate_hz`: found \"1e10\", expected 0.01 to 100000 images per second"},
    {"rate_hz",
     "rate_hz: 1e-300",
     ":12: key `rate_hz`: found \"1e-300\", expected 0.01 to 100000 images per second"}};

TEST(CalibrationFile, NamesLineAndKeyOfErrors) {
  const TestFolder folder;
  for (const auto& [key, lines, message] : kBadLines) {
    const std::string text = *key == '\0' ? std::string(kEuroc) + lines : with(key, lines);
    const auto file = folder.write("sensor.yaml", text);
    EXPECT_EQ(error_of([&] { read_calibration(file); }), file.string() + message);
  }
}

TEST(CalibrationFile, RefusesAMatrixThatIsNoRotation) {
  const TestFolder folder;
  const std::string head =
      "resolution: [64, 48]\nintrinsics: [60, 60, 32, 24]\ndistortion_model: none\nT_BS: ";
  const auto message = [&](const std::string& T) {
    return error_of([&] { read_calibration(folder.write("camera.yaml", head + T)); });
  };
  EXPECT_THAT(message("[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"),
              HasSubstr("camera.yaml:4: key `T_BS`: found a matrix that is no rotation"));
  EXPECT_THAT(message("[-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"),
              HasSubstr("found a matrix that is no rotation"));
  EXPECT_THAT(message("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1]"),
              HasSubstr("found another last row, expected 0, 0, 0, 1"));
  EXPECT_THAT(message("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]"),
              HasSubstr("found 12 numbers, expected 16 (a 4x4 matrix, row by row)"));
}

TEST(CalibrationFile, NamesTheLineOfBadSyntax) {
  const TestFolder folder;
  const auto file = folder.write("camera.yaml", "resolution: [64, 48\nintrinsics: [1, 2, 3, 4]\n");
  EXPECT_THAT(error_of([&] { read_calibration(file); }),
              testing::AllOf(HasSubstr("camera.yaml:2: found"), HasSubstr("expected YAML")));
  EXPECT_THAT(error_of([&] { read_calibration(folder.write("camera.yaml", "")); }),
              HasSubstr("camera.yaml: found no value, expected keys and values"));
}

}  // namespace
}  // namespace gpo
