// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Recordings that people brought: photos with EXIF, boards, gaps and wrong clocks of an IMU.
#include "engine/recording/companions/companion_files.h"
#include "tests/app/program.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

using testing::HasSubstr;

fs::path case_folder(const std::string& name) { return shared("cases/" + name); }

TEST(SensorCases, PhotosCalibrateAlikeWhateverTheirOrientationInExif) {
  // OpenCV 4.10, of Debian 13, finds slightly different corners; one sigma of cy is 1.07 px.
  const double cy = std::string_view(GPO_SUITE) == "debian13" ? 239.0 : 237.8;
  const fs::path folder = fresh_folder();
  std::optional<Camera> first;
  for (const char* name :
       {"visp-chessboard", "exif-turned-photos/mixed", "exif-turned-photos/upside-down"}) {
    const fs::path photos = case_folder(name);
    SKIP_WITHOUT(photos);
    succeeding("calibrate {} --board 9x6 --square 0.025 --output {}/camera.yaml", photos, folder);
    const Camera camera = read_calibration(folder / "camera.yaml").camera;
    EXPECT_NEAR(camera.fx, 533.6, 1.3) << name;
    EXPECT_NEAR(camera.cx, 342.4, 1) << name;
    EXPECT_NEAR(camera.cy, cy, 1) << name;
    if (!first) first = camera;
    EXPECT_NEAR(camera.fx, first->fx, 1e-3) << name;
    EXPECT_NEAR(camera.cy, first->cy, 1e-3) << name;
  }
}

TEST(SensorCases, SquaresCountedInsteadOfCornersGetAHint) {
  const fs::path photos = case_folder("visp-chessboard");
  SKIP_WITHOUT(photos);
  expect_exit(
      1,
      program(
          "calibrate {} --board 10x7 --square 0.025 --output {}/c.yaml", photos, fresh_folder()),
      "The images show a chessboard of 9x6 inner corners; use --board 9x6");
}

TEST(SensorCases, AGapOfTheImuCostsTheGyroscopeAndNotTheRun) {
  const fs::path gap = case_folder("imu-gap-and-clock/gap-80ms");
  SKIP_WITHOUT(gap);
  const std::string text = succeeding("run {}", gap).out;
  EXPECT_THAT(text, HasSubstr("the gyroscope is not used: "));
  EXPECT_THAT(text, HasSubstr("gap of 0.080 s in the gyroscope's samples"));
}

TEST(SensorCases, ALateClockOfTheImuIsCorrectedAndTheScaleHolds) {
  const fs::path late = case_folder("imu-gap-and-clock/late-30ms");
  SKIP_WITHOUT(late);
  const fs::path file = fresh_folder() / "result.json";
  EXPECT_THAT(succeeding("run {} --json {}", late, file).out,
              HasSubstr("the gyroscope does not fit the images: its clock is about +"));
  const auto result = read_json(file);
  const double error_percent = result.at("metrics").at("scale_error_percent");
  EXPECT_LT(std::abs(error_percent), 3);
}

}  // namespace
}  // namespace gpo::test
