// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/calibrate.h"

#include "engine/geometry/pose.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "tests/app/program.h"
#include "tests/engine/recording/board/rendered_board.h"

#include <cmath>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

const char* const kBoardFile = "{pattern: chessboard, columns: 9, rows: 6, square: 0.025}\n";

/// Writes images of the board from many sides, without a calibration.
void write_images(const fs::path& folder, int count) {
  fs::create_directories(folder);
  for (int i = 0; i < count; ++i) {
    const double turn = 2.4 * i;
    const double tilt_deg = 38 * std::sin(turn);
    Pose pose = looking_at(kChessboard, 0.3 + 0.02 * (i % 5), tilt_deg, 12.0 * (i % 7));
    const Eigen::Matrix3d R = pose.R_wc * so3_exp({0, radians(25 * std::cos(turn)), 0});
    const Eigen::Vector3d aside(0.05 * std::sin(1.7 * i), 0.03 * std::cos(2.9 * i), 0);
    pose = {R, Eigen::Vector3d(0.1, 0.0625, 0) + aside - (0.3 + 0.02 * (i % 5)) * R.col(2)};
    write_image(folder / fmt::format("{:03d}.png", i),
                render_board(kChessboard, small_lens(), pose));
  }
}

void write_blank_images(const fs::path& folder, int count) {
  fs::create_directories(folder);
  for (int i = 0; i < count; ++i)
    write_image(folder / fmt::format("{}.png", i), cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(90)));
}

std::vector<double> numbers_of(const fs::path& file, const char* key) {
  return numbers(at(load_yaml(file), key, "numbers"));
}

TEST(CalibrateCommand, CalibratesFromAChessboard) {
  const fs::path folder = fresh_folder();
  write_images(folder / "in", 24);
  const fs::path output = folder / "in/camera.yaml";
  const Outcome outcome =
      succeeding("calibrate {} --board 9x6 --square 0.025 --output {}", folder / "in", output);
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, testing::AllOf(HasSubstr("RMS "), HasSubstr(" +- ")));
  const auto found = parameters(read_calibration(output).camera);
  auto sigmas = numbers_of(output, "intrinsics_sigma");
  const auto of_lens = numbers_of(output, "distortion_coefficients_sigma");
  sigmas.insert(sigmas.end(), of_lens.begin(), of_lens.end());
  const auto truth = parameters(small_lens());
  for (std::size_t k = 0; k < truth.size(); ++k)
    EXPECT_LT(std::abs(found[k] - truth[k]), 3 * sigmas[k]) << k;
  EXPECT_LT(sigmas[0], 6);
  // Now it is a recording, with ground truth from board.yaml.
  write_file(folder / "in/board.yaml", kBoardFile);
  EXPECT_THAT(succeeding("info {}", folder / "in").out, HasSubstr("uncertainty"));
  // Its camera.yaml is compared, not replaced.
  const std::string before = read_file(output);
  const Outcome again =
      succeeding("calibrate {} --coefficients 5 --output {}", folder / "in", output);
  EXPECT_THAT(again.out,
              testing::AllOf(HasSubstr("compared with the recording's calibration:"),
                             HasSubstr(" sigma)"),
                             HasSubstr("is not replaced; choose another --output")));
  EXPECT_EQ(read_file(output), before);
  // One of another size, with which the images cannot be opened, stays, too.
  write_file(output, "resolution: [64, 48]\nintrinsics: [50, 50, 32, 24]\n");
  expect_refused(program("calibrate {} --output {}", folder / "in", output),
                 "does not fit the images; remove it, or choose another --output");
  write_file(output, before);
  // The board is read from board.yaml.
  succeeding("calibrate {} --coefficients 5 --output {}", folder / "in", folder / "again.yaml");
  EXPECT_EQ(numbers_of(folder / "again.yaml", "distortion_coefficients").size(), 5U);
}

TEST(CalibrateCommand, WarnsIfBoardOptionsAreUnused) {
  const fs::path folder = fresh_folder();
  write_blank_images(folder / "in", 2);
  const std::string calibrate = fmt::format("calibrate {0}/in --output {0}/camera.yaml ", folder);
  write_file(folder / "in/board.yaml", kBoardFile);
  EXPECT_EQ(program(calibrate + "--square 0.03 --pattern charuco").err,
            fmt::format("--square, --pattern: not used, {}/in/board.yaml describes the board; "
                        "add --board to describe another one\n",
                        folder));
  EXPECT_EQ(program(calibrate).err, "");
  EXPECT_EQ(program(calibrate + "--board 9x6 --square 0.03").err, "");
}

TEST(CalibrateCommand, WarnsAboutSquaresInMillimeters) {
  const fs::path folder = fresh_folder();
  write_blank_images(folder, 1);
  EXPECT_EQ(program("calibrate {0} --board 9x6 --square 25 --output {0}/camera.yaml", folder).err,
            "a square of 25 m is unusually large: lengths are in meters, and 25 mm are 0.025 m\n");
}

TEST(CalibrateCommand, UndeterminedCoefficientsStayZero) {
  const fs::path output = fresh_folder() / "camera.yaml";
  EXPECT_THAT(succeeding("calibrate {} --model equidistant --output {}", kDesk, output).out,
              HasSubstr("warning     k4 is not determined by these views ("));
  const Camera found = read_calibration(output).camera;
  EXPECT_EQ(found.coefficients.back(), 0);
  for (const double k : found.coefficients) EXPECT_LT(std::abs(k), 10);
  EXPECT_NEAR(found.fx, 500, 20);
}

TEST(CalibrateCommand, ComparesWithTheRecordingAndWritesElsewhere) {
  const fs::path output = fresh_folder() / "camera.yaml";
  const Outcome outcome = succeeding("calibrate {} --output {}", kDesk, output);
  EXPECT_THAT(outcome.out, HasSubstr(", recorded 498.20: "));
  EXPECT_THAT(outcome.out, testing::Not(HasSubstr("is not replaced")));
  EXPECT_NEAR(read_calibration(output).camera.fx, 498.2, 10);  // +- 9.2
}

TEST(CalibrateCommand, CalibratesOrRefusesAWideLens) {
  const fs::path folder = fresh_folder();
  struct Case {
    const char* name;
    const char* options;
    double fx;  ///< 0: refused
  };
  for (const auto& [name, options, fx] :
       {Case{"wide-lens-board", "--model equidistant", 281.85},
        Case{"wide-lens-board", "--coefficients 8", 281.85},
        Case{"wide-lens-board", "--coefficients 5", 0},
        Case{"wide-lens-board", "", 0},
        Case{"calibrate-success-at-148px", "--model equidistant", 507.3},
        Case{"calibrate-success-at-148px", "", 507.3}}) {
    SCOPED_TRACE(fmt::format("{} {}", name, options));
    const fs::path images = shared(fmt::format("cases/{}", name)), output = folder / "camera.yaml";
    SKIP_WITHOUT(images);
    fs::remove(output);
    const Outcome outcome =
        program("calibrate {} --board 8x6 --square 0.025 {} --output {}", images, options, output);
    if (fx == 0) {
      expect_exit(1, outcome, "calibration failed: ");
      EXPECT_THAT(outcome.out, HasSubstr("try --model equidistant or --coefficients 8"));
      EXPECT_FALSE(fs::exists(output));
      continue;
    }
    ASSERT_EQ(outcome.exit_code, 0) << outcome.out << outcome.err;
    const double sigma = numbers_of(output, "intrinsics_sigma")[0];
    const double found = read_calibration(output).camera.fx;
    EXPECT_GT(sigma, 0);
    EXPECT_LT(std::abs(found - fx), 3 * sigma) << found << " +- " << sigma;
    EXPECT_NEAR(found, fx, 0.005 * fx);
  }
}

TEST(CalibrateCommand, FindsTheOrientationOfTheGyroscope) {
  const fs::path folder = fresh_folder();
  const std::string calibrate =
      fmt::format("calibrate {} --gyroscope --output {}/camera.yaml ", kDesk, folder);
  EXPECT_THAT(succeeding("{}--figure {}/rates.png", calibrate, folder).out,
              HasSubstr("the camera's x along -y, y along -x, z along -z of the gyroscope"));
  EXPECT_FALSE(read_image(folder / "rates.png").empty());
  const Calibration found = read_calibration(folder / "camera.yaml");
  const Calibration known = read_calibration(desk() / "mav0/cam0/sensor.yaml");
  const Eigen::Matrix3d off = found.T_body_camera->R_wc.transpose() * known.T_body_camera->R_wc;
  EXPECT_LT(degrees(so3_log(off).norm()), 0.3);
  EXPECT_LT(std::abs(found.time_offset_ns), 1'000'000);
  EXPECT_NEAR(found.camera.fx, known.camera.fx, 1e-6);
  expect_exit(2, program(calibrate + "--board 9x6"), "--board excludes --gyroscope");
}

TEST(CalibrateCommand, ReportsWhyItFailedAndWritesNothing) {
  const fs::path folder = fresh_folder();
  write_blank_images(folder / "in", 3);
  const std::string calibrate = fmt::format("calibrate {0}/in --output {0}/camera.yaml ", folder);
  expect_exit(1,
              program(calibrate + "--from plane"),
              "calibration failed: a plane is seen in 0 images; at least 6 are needed");
  expect_exit(1,
              program(calibrate + "--board 9x6 --square 0.025"),
              "calibration failed: found the board in 0 of 3 images; at least 8 are needed");
  expect_exit(
      2, program(calibrate + "--from plane --board 9x6"), "--board: not used with --from plane");
  expect_exit(2, program(calibrate + "--gyroscope"), "has no gyroscope");
  EXPECT_FALSE(fs::exists(folder / "camera.yaml"));
}

TEST(CalibrateCommand, UncalibratedCameraIsReportedAsGuess) {
  const fs::path folder = fresh_folder();
  const fs::path all = desk() / "mav0/cam0/data";
  const std::set<fs::path> images(fs::directory_iterator(all), fs::directory_iterator{});
  auto image = images.begin();
  for (int number = 0; number < 30; ++number)
    fs::copy_file(*image++, folder / fmt::format("{}.jpg", number));
  const Outcome run = program("run {} --json -", folder);
  const auto json = json::parse(run.out);
  EXPECT_EQ(json["camera"]["source"], "guess");
  EXPECT_NE(json["verdict"]["readiness"], "ready");
  EXPECT_THAT(run.err, HasSubstr("no calibration: assuming a 70 deg"));
  EXPECT_THAT(run.err, HasSubstr("camera      a guess, f 571 px"));
  for (const auto& [path, source] : {std::pair(folder, "guess"), std::pair(desk(), "file")})
    EXPECT_EQ(json::parse(program("info {} --json", path).out)["camera"]["source"], source);
}

TEST(CalibrateCommand, RefusesBadInputInOneLineAndLeavesNoFile) {
  expect_each_refused(
      "calibrate --output {}/camera.yaml ",
      {{"assets --board 9y6 --square 0.02",
        "--board: '9y6', expected COLUMNSxROWS of inner corners, 3 to 100 each"},
       {"assets --board 9x2 --square 0.02", "--board: '9x2', expected"},
       {"assets --board 9x6", "--square is required with --board"},
       {"assets --board 9x6 --square -1", "--square: -1, expected a length in meters, > 0"},
       {"assets", "--board is required: there is no assets/board.yaml"},
       {"assets/fonts --board 9x6 --square 0.02",
        "assets/fonts: found no images, expected a video or numbered images"},
       {"README.md --board 9x6 --square 0.02", "README.md: unsupported file"},
       {"no/such --board 9x6 --square 0.02", "no/such: no such file or folder"},
       {"assets --board 4294967305x6 --square 0.02", "--board: '4294967305x6', expected"},
       {"assets --pattern charuco --board 8x6 --square 0.03 --marker 0.04",
        "--marker: 0.04, expected less than the square's side, 0.03"},
       {"assets --pattern charuco --board 8x6 --square 0.03 --marker 0.02",
        "--dictionary: '', expected one of DICT_4X4_50, "},
       {"assets --board 9x6 --square 0.02 --model equidistant --coefficients 5",
        "--coefficients: 5, expected 4 with --model equidistant"},
       {"assets --board 9x6 --square 0.02 --coefficients 6", "--coefficients"}});
  expect_refused(
      program("calibrate assets --board 9x6 --square 0.02 --output README.md/camera.yaml"),
      "README.md/camera.yaml: cannot be written, there is no folder README.md");
  expect_refused(program("calibrate README.md --board 9x6 --square 0.02 --output README.md"),
                 "--output and recording: found README.md for both");
}

/// A board on paper that is not flat, which its camera.yaml ignores, and the focal lengths from
/// OpenCV's object releasing method on every sixth image.
class RealCalibration : public testing::TestWithParam<std::tuple<const char*, double, double>> {};

TEST_P(RealCalibration, ModelsPaperThatIsNotFlat) {
  const auto& [name, fx, fy] = GetParam();
  const fs::path recording = shared(name);
  SKIP_WITHOUT(recording);
  const fs::path output = fresh_folder() / "camera.yaml";
  const Outcome outcome = succeeding("calibrate {} --output {}", recording, output);
  EXPECT_THAT(outcome.out, HasSubstr("not flat"));
  const Camera found = read_calibration(output).camera;
  const auto sigmas = numbers_of(output, "intrinsics_sigma");
  EXPECT_LT(std::abs(found.fx - fx), 3 * sigmas[0]) << outcome.out;
  EXPECT_LT(std::abs(found.fy - fy), 3 * sigmas[1]) << outcome.out;
  EXPECT_LT(sigmas[0], 0.015 * found.fx);
}

INSTANTIATE_TEST_SUITE_P(All,
                         RealCalibration,
                         testing::Values(std::tuple("chessboard-floor", 1089.1, 1094.2),
                                         std::tuple("chessboard-dark", 467.1, 462.6)));

}  // namespace
}  // namespace gpo::test
