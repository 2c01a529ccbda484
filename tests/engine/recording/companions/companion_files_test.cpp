// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/companions/companion_files.h"

#include "engine/files/text_file.h"
#include "tests/engine/recording/recording_folder.h"

#include <opencv2/core/persistence.hpp>

namespace gpo::test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

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

class CalibrationFile : public testing::Test {
 protected:
  Calibration read(const std::string& text, const char* name = "camera.yaml") const {
    return read_calibration(folder.write(name, text));
  }
  std::string error(const std::string& text, const char* name = "camera.yaml") const {
    return error_of([&] { read(text, name); });
  }

  const TestFolder folder;
};

TEST_F(CalibrationFile, ReadsEurocsSensorFile) {
  const auto calibration = read(kEuroc);
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

TEST_F(CalibrationFile, ReadsFileStorageInAllFormatsAndWithAllNames) {
  const cv::Mat k =
      (cv::Mat_<double>(12, 1) << -0.29, 0.1, 1e-3, -2e-4, 0.013, 1, 2, 3, 4, 5, 6, 7);
  for (const char* file : {"camera.xml", "camera.yaml", "camera.yml", "camera.json"}) {
    for (const auto& [matrix, coefficients] :
         {std::pair("camera_matrix", "distortion_coefficients"),
          {"cameraMatrix", "distCoeffs"},
          {"Camera_Matrix", "Distortion_Coefficients"},
          {"K", "D"}}) {
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
      EXPECT_EQ(cv::Size(camera.width, camera.height), cv::Size(640, 480));
      EXPECT_THAT((std::array{camera.fx, camera.fy, camera.cx, camera.cy}),
                  testing::Pointwise(testing::DoubleEq(), {533.25, 534.0, 341.5, 231.125}));
      EXPECT_EQ(camera.distortion, Distortion::radial_tangential);
      EXPECT_THAT(camera.coefficients,
                  testing::Pointwise(testing::DoubleEq(), std::vector<double>(k)));
    }
  }
}

TEST_F(CalibrationFile, NamesTheLineOfBadXml) {
  const auto message = [&](const std::string& text) { return error(text, "camera.xml"); };
  EXPECT_THAT(message("<?xml version=\"1.0\"?>\n<opencv_storage>\n<K>\n</opencv_storage>\n"),
              testing::AllOf(HasSubstr("camera.xml:"), HasSubstr("expected XML")));
  EXPECT_THAT(message(" <"), HasSubstr("expected XML"));
  EXPECT_THAT(message("<opencv_storage><K>1 2 3</K></opencv_storage>"),
              HasSubstr("camera.xml: key `K`: found 3 numbers, expected 9 (a 3x3 matrix)"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_THAT(message(deep), HasSubstr("expected XML"));
}

TEST_F(CalibrationFile, FindsUsualFileNames) {
  for (const std::string& name :
       split("camera.yaml camera.yml sensor.yaml camchain-imucam.yaml desk-camchain.yaml "
             "camchain-imucam-2026-01-01.yaml calibration.xml out_camera_data.xml",
             ' ')) {
    const TestFolder folder;
    folder.write("notes.yaml", "");
    EXPECT_FALSE(search_calibration({folder.path()}).file);
    folder.write(name, "");
    EXPECT_EQ(search_calibration({folder.path()}).file, folder.path() / name);
  }
}

TEST_F(CalibrationFile, ReadsKalibrsChain) {
  const auto calibration = read(R"(cam0:
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
)");
  EXPECT_EQ(calibration.camera.distortion, Distortion::equidistant);
  EXPECT_EQ(calibration.camera.coefficients.size(), 4U);
  EXPECT_EQ(calibration.time_offset_ns, -2500000);
  ASSERT_TRUE(calibration.T_body_camera);
  // The camera's -y is the IMU's x.
  const Pose& T = *calibration.T_body_camera;
  EXPECT_TRUE((T.R_wc * Eigen::Vector3d(0, -1, 0)).isApprox(Eigen::Vector3d::UnitX()));
  EXPECT_TRUE(T.p_wc.isApprox(Eigen::Vector3d(0.2, -0.1, -0.3)));
}

TEST_F(CalibrationFile, ReadsTheLensUncertainty) {
  const auto with_lines = [&](const std::string& lines) {
    return read(kEuroc + lines).camera.sigmas;
  };
  EXPECT_TRUE(with_lines("").empty());
  EXPECT_THAT(with_lines("intrinsics_sigma: [1, 2, 3, 4]\n"), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(with_lines("intrinsics_sigma: [1, 2, 3, 4]\n"
                         "distortion_coefficients_sigma: [0.1, 0.2, 0, 0]\n"),
              ElementsAre(1, 2, 3, 4, 0.1, 0.2, 0, 0));
}

/// Line with the covariance of 8 parameters with standard deviations 2 whose first two are
/// correlated.
std::string covariance_line(double correlation) {
  std::string values;
  for (int row = 0; row < 8; ++row)
    for (int column = row; column < 8; ++column)
      values += fmt::format("{}{}",
                            row + column > 0 ? ", " : "",
                            row == column             ? 4
                            : row == 0 && column == 1 ? 4 * correlation
                                                      : 0);
  return "intrinsics_covariance: [" + values + "]\n";
}

TEST_F(CalibrationFile, CovarianceTakesPrecedenceOverSigmas) {
  for (const char* sigmas : {"", "intrinsics_sigma: [1, 1, 1, 1]\n"}) {
    const Camera camera = read(kEuroc + (sigmas + covariance_line(0.5))).camera;
    EXPECT_EQ(camera.sigmas, std::vector(8, 2.0));
    const Eigen::MatrixXd covariance = from_upper_triangle(camera.covariance);
    EXPECT_EQ(covariance(0, 1), 2);
    EXPECT_EQ(covariance(1, 0), 2);
    EXPECT_EQ(covariance.trace(), 32);
  }
}

TEST_F(CalibrationFile, ReadsTheReadoutTimeAndSigmasOfAllFormats) {
  const std::string opencv =
      "%YAML:1.0\nimage_width: 640\nimage_height: 480\ncamera_matrix: !!opencv-matrix\n"
      "  rows: 3\n  cols: 3\n  dt: d\n  data: [500, 0, 320, 0, 500, 240, 0, 0, 1]\n";
  for (const std::string& head : {std::string(kEuroc), opencv}) {
    EXPECT_FALSE(read(head).camera.readout);
    EXPECT_EQ(read(head + "readout_s: 0.02\n").camera.readout, (Readout{0.02, 4e-4}));
    EXPECT_EQ(read(head + "readout_s: -0.02\nreadout_sigma_s: 0.001\n").camera.readout,
              (Readout{-0.02, 0.001}));
    EXPECT_EQ(read(head + "readout_s: 0\n").camera.readout, (Readout{0, 1e-4}));
    EXPECT_FALSE(read(head).camera.readout_direction);
    EXPECT_EQ(read(head + "readout_direction: left\n").camera.readout_direction,
              ReadoutDirection::left);
    EXPECT_THAT(read(head + "intrinsics_sigma: [1, 2, 3, 4]\n").camera.sigmas,
                ElementsAre(1, 2, 3, 4));
  }
}

/// Returns EuRoC's file with the line of the same key replaced, removed if `line` is only a key, or
/// added at the end.
std::string with(const std::string& line) {
  std::string text = kEuroc;
  const std::string key = line.substr(0, line.find(':'));
  const std::size_t found = text.find("\n" + key + ":");
  if (found == std::string::npos) return text + line;
  return text.replace(found + 1, text.find('\n', found + 1) - found - 1, line == key ? "" : line);
}

TEST_F(CalibrationFile, NamesLineAndKeyOfErrors) {
  const std::vector<Refusal> refusals = {
      {with("camera_model: omni"),
       ":15: key `intrinsics`: found 4 numbers, expected 5 (xi, fx, fy, cx, cy)"},
      {with("distortion_model: cubic"),
       ":16: key `distortion_model`: found \"cubic\", expected none, radial-tangential, equi..."},
      {with("distortion_model: none"),
       ":17: key `distortion_coefficients`: found 4 numbers, expected none for distortion model "
       "none"},
      {with("distortion_coefficients: [1, 2, 3]"),
       ":17: key `distortion_coefficients`: found 3 numbers, expected 4, 5, 8, 12 or 14 (k1, k2, "
       "p1, p2, k3, ...) for distortion model radial-tangential"},
      {with("distortion_coefficients: [1, 2, .nan, 4]"),
       ":17: key `distortion_coefficients`: found \".nan\", expected finite numbers"},
      {with("distortion_coefficients"),
       ": key `distortion_coefficients`: found no value, expected a list of numbers"},
      {with("intrinsics: [458, 457, 367]"),
       ":15: key `intrinsics`: found 3 numbers, expected 4 (fx, fy, cx, cy)"},
      {with("intrinsics: [458, -457, 367, 248]"),
       ":15: key `intrinsics`: found 458, -457, expected plausible fx, fy > 0 in pixels"},
      {with("intrinsics: [458, 457, 367, 9000]"),
       ":15: key `intrinsics`: found 367, 9000, expected cx, cy in pixels, near the image center"},
      {with("intrinsics"), ": key `intrinsics`: found no value, expected [fx, fy, cx, cy]"},
      {with("resolution: [752.5, 480]"),
       ":13: key `resolution`: found 752.5x480, expected [width, height] in pixels"},
      {with("resolution: 752x480"),
       ":13: key `resolution`: found \"752x480\", expected a list of numbers"},
      {with("intrinsics_sigma: [1, 2]"),
       ":18: key `intrinsics_sigma`: found 2 numbers, expected 4 (of fx, fy, cx, cy)"},
      {with("intrinsics_sigma: [1, -2, 3, 4]"),
       ":18: key `intrinsics_sigma`: found an implausible standard deviation, expected numbers "
       "from 0 on"},
      {with("intrinsics_sigma: [1, 2, 3, 4]\ndistortion_coefficients_sigma: [0.1]"),
       ":19: key `distortion_coefficients_sigma`: found 1 number, expected one for each of the "
       "distortion coefficients"},
      {with("intrinsics_covariance: [1, 0, 1]"),
       ":18: key `intrinsics_covariance`: found 3 numbers, expected 36 (upper triangle, row by "
       "row, of fx, fy, cx, cy and 4 coefficients)"},
      {with(covariance_line(1.5)),
       ":18: key `intrinsics_covariance`: found a matrix that is no covariance, expected a "
       "positive semidefinite one"},
      {with("intrinsics_covariance: [1, .inf]"),
       ":18: key `intrinsics_covariance`: found \".inf\", expected finite numbers"},
      {with("readout_s: 1.5"),
       ":18: key `readout_s`: found 1.5, expected seconds from the first row to the last, "
       "less than 1"},
      {with("readout_s: 0.02\nreadout_sigma_s: -1"),
       ":19: key `readout_sigma_s`: found -1, expected seconds above 0 and less than 1"},
      {with("readout_s: 0.02\nreadout_sigma_s: 10"),
       ":19: key `readout_sigma_s`: found 10, expected seconds above 0 and less than 1"},
      {with("readout_direction: diagonal"),
       ":18: key `readout_direction`: found \"diagonal\", expected down, left, up or right"},
      {with("rate_hz: 0"),
       ":12: key `rate_hz`: found \"0\", expected 0.01 to 100000 images per second"},
      {with("rate_hz: 1e10"),
       ":12: key `rate_hz`: found \"1e10\", expected 0.01 to 100000 images per second"},
      {with("rate_hz: 1e-300"),
       ":12: key `rate_hz`: found \"1e-300\", expected 0.01 to 100000 images per second"}};
  expect_refusals("sensor.yaml", refusals, [](const auto& file) { read_calibration(file); });
}

TEST_F(CalibrationFile, RefusesAMatrixThatIsNoRotation) {
  const std::string head =
      "resolution: [64, 48]\nintrinsics: [60, 60, 32, 24]\ndistortion_model: none\nT_BS: ";
  const auto message = [&](const std::string& T) { return error(head + T); };
  EXPECT_THAT(message("[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"),
              HasSubstr("camera.yaml:4: key `T_BS`: found a matrix that is no rotation"));
  EXPECT_THAT(message("[-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]"),
              HasSubstr("found a matrix that is no rotation"));
  EXPECT_THAT(message("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1]"),
              HasSubstr("found another last row, expected 0, 0, 0, 1"));
  EXPECT_THAT(message("[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]"),
              HasSubstr("found 12 numbers, expected 16 (a 4x4 matrix, row by row)"));
}

TEST_F(CalibrationFile, NamesTheLineOfBadSyntax) {
  EXPECT_THAT(error("resolution: [64, 48\nintrinsics: [1, 2, 3, 4]\n"),
              testing::AllOf(HasSubstr("camera.yaml:2: found"), HasSubstr("expected YAML")));
  EXPECT_THAT(error(""), HasSubstr("camera.yaml: found no value, expected keys and values"));
}

TEST(BoardFile, CountsSquaresOfACharucoBoard) {
  const TestFolder folder;
  const auto file = folder.write("board.yaml",
                                 "{pattern: charuco, squares: [8, 6], square: 0.03, marker: 0.022, "
                                 "dictionary: 5x5_100}\n");
  const Board board = read_board(file);
  ASSERT_TRUE(board.markers);
  EXPECT_EQ(text_of(board), text_of(Board{7, 5, 0.03, BoardMarkers{0.022, "DICT_5X5_100"}}));
}

TEST(BoardFile, NamesLineAndKeyOfErrors) {
  const std::vector<Refusal> refusals = {
      {"pattern: circles\n",
       ":1: key `pattern`: found \"circles\", expected chessboard, charuco, aprilgrid or "
       "apriltag"},
      {"pattern: chessboard\ncolumns: 9.5\nrows: 6\nsquare: 0.02\n",
       ":2: key `columns`: found \"9.5\", expected a number of inner corners..."},
      {"pattern: chessboard\ncolumns: 9\nrows: 2\nsquare: 0.02\n",
       ":3: key `rows`: found \"2\", expected a number of inner corners, 3 to 100"},
      {"pattern: chessboard\ncolumns: 9\nrows: 6\n",
       ": key `square`: found no value, expected the side of a square in meters"},
      {"pattern: chessboard\ncolumns: 9\nrows: 6\nsquare: -1\n",
       ":4: key `square`: found -1, expected the side of a square in meters, > 0"},
      {"pattern: charuco\ncolumns: 9\nrows: 6\nsquare: 0.02\n",
       ": key `squares`: found no value, expected 2 counts of squares (x, y), 3 to 100..."},
      {"pattern: charuco\nsquares: [8, 2]\n",
       ":2: key `squares`: found 2, expected 2 counts of squares (x, y), 3 to 100 each"},
      {"pattern: charuco\nsquares: [8]\n",
       ":2: key `squares`: found 1 number, expected 2 counts of squares (x, y)..."},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\n",
       ": key `marker`: found no value, expected the side of a marker in meters"},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: 0.03\n",
       ":4: key `marker`: found 0.03, expected less than the square's side, 0.03"},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: -1\n",
       ":4: key `marker`: found -1, expected the side of a marker in meters, > 0"},
      {"pattern: charuco\nsquares: [8, 6]\nsquare: 0.03\nmarker: 0.02\n"
       "dictionary: DICT_5X5_99\n",
       ":5: key `dictionary`: found \"DICT_5X5_99\", expected one of DICT_4X4_50, ..."},
      {"pattern: charuco\nsquares: [12, 9]\nsquare: 0.03\nmarker: 0.02\n"
       "dictionary: DICT_4X4_50\n",
       ":5: key `dictionary`: found DICT_4X4_50 with 50 markers, expected at least "
       "54, one for each marker of the board"},
      {"pattern: aprilgrid\ntagCols: 6\ntagRows: 0\n",
       ":3: key `tagRows`: found \"0\", expected a number of tags, 1 to 50"},
      {"pattern: aprilgrid\ntagCols: 6\ntagRows: 6\ntagSize: 0\n",
       ":4: key `tagSize`: found 0, expected the side of a tag in meters, > 0"},
      {"pattern: aprilgrid\ntagCols: 6\ntagRows: 6\ntagSize: 0.1\ntagSpacing: 30\n",
       ":5: key `tagSpacing`: found 30, expected the gap between tags divided by their side, 0 "
       "to 1"},
      {"pattern: aprilgrid\ntagCols: 25\ntagRows: 24\ntagSize: 1\ntagSpacing: 0.3\n",
       ":2: key `tagCols`: found 600 tags, expected at most 587"},
      {"pattern: aprilgrid\ntagCols: 2\ntagRows: 2\ntagSize: 1\ntagSpacing: 0.3\n"
       "tagBorder: 3\n",
       ":6: key `tagBorder`: found \"3\", expected a number of bits, 1 to 2"},
      {"pattern: apriltag\ntagSize: 0.1\nid: 587\n",
       ":3: key `id`: found \"587\", expected a tag's number, 0 to 586"}};
  expect_refusals("board.yaml", refusals, [](const auto& file) { read_board(file); });
}

TEST(PlaneFile, NamesLineAndKeyOfErrors) {
  const std::vector<Refusal> refusals = {
      {"normal: [0, 0, 2]\ndistance: 1\n",
       ":1: key `normal`: found length 2.000000, expected a unit vector"},
      {"normal: [0, 0, 1]\ndistance: far\n",
       ":2: key `distance`: found \"far\", expected a finite number"},
      {"normal: [0, 1]\ndistance: 1\n", ":1: key `normal`: found 2 numbers, expected 3..."}};
  expect_refusals("plane.yaml", refusals, [](const auto& file) { read_plane(file); });
}

TEST(BoardFile, ReadsAndWritesKalibrsKeys) {
  const TestFolder folder;
  const Board grid = read_board(folder.write("april_6x7.yaml",
                                             "target_type: 'aprilgrid'\ntagCols: 6\ntagRows: 7\n"
                                             "tagSize: 0.088\ntagSpacing: 0.3\n"));
  EXPECT_EQ(grid.columns, 12);
  EXPECT_EQ(grid.rows, 14);
  EXPECT_EQ(grid.square_m, 0.088);
  ASSERT_TRUE(grid.tags);
  EXPECT_EQ(grid.tags->spacing, 0.3);
  EXPECT_EQ(grid.tags->border, 2);
  EXPECT_FALSE(grid.tags->alone);
  const Board tag =
      read_board(folder.write("tag.yaml", "{pattern: apriltag, tagSize: 0.1, id: 3}"));
  EXPECT_EQ(tag.columns, 2);
  EXPECT_EQ(tag.tags->border, 1);
  EXPECT_EQ(tag.tags->alone, 3);
  for (const Board& board : {grid, tag}) {
    const Board again = read_board(folder.write("board.yaml", board_yaml(board)));
    EXPECT_EQ(text_of(again), text_of(board));
    EXPECT_EQ(again.tags->alone, board.tags->alone);
  }
}

}  // namespace
}  // namespace gpo::test
