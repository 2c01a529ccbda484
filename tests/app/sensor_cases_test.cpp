// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Recordings that people brought: photos with EXIF, boards, gaps and wrong clocks of an IMU.
#include "engine/files/output_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/images.h"
#include "tests/app/program.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <opencv2/core.hpp>

namespace gpo::test {
namespace {

using testing::HasSubstr, testing::Not;

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

TEST(SensorCases, PhotosAreShownAsExifTurnsThem) {
  const fs::path folder = fresh_folder(), turned = case_folder("exif-turned-photos/upside-down");
  SKIP_WITHOUT(turned);
  write_file(folder / "script", "legend off\ntracks off\nscreenshot shown.png picture\n");
  for (const fs::path& photos : {case_folder("visp-chessboard"), turned}) {
    const fs::path place = folder / photos.filename();
    fs::create_directories(place);
    const Outcome drawn =
        shell("cd {} && {} snapshot {} --frames 2 --script ../script", place, GPO_PROGRAM, photos);
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  }
  cv::Mat expected;
  cv::rotate(read_image(folder / "visp-chessboard/shown.png"), expected, cv::ROTATE_180);
  const cv::Rect without_badge(0, 110, 640, 260);
  const cv::Mat shown = read_image(folder / "upside-down/shown.png");
  EXPECT_LT(cv::norm(shown(without_badge), expected(without_badge), cv::NORM_INF), 1);
}

TEST(SensorCases, ARepeatedFrameLateInALongRecordingIsLeftOutByTheWindowAndByRun) {
  const fs::path folder = fresh_folder(), images = folder / "images";
  fs::create_directories(images);
  constexpr int kFrames = 430, kRepeated = 410;
  for (int i = 0; i < kFrames; ++i) {
    const int shown = i == kRepeated ? i - 1 : i;
    cv::Mat image(48, 64, CV_8UC3);
    cv::RNG random(static_cast<std::uint64_t>(shown + 1));
    for (int y = 0; y < image.rows; ++y)
      for (int x = 0; x < image.cols; ++x)
        image.at<cv::Vec3b>(y, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(
            120 + 50 * std::sin(0.4 * (x + shown)) * std::cos(0.3 * y) + random.gaussian(1)));
    write_image(images / fmt::format("{:04}.png", i), image);
  }
  write_file(folder / "script", "frames 8\n");
  constexpr const char* kNote = "1 of 430 frames are left out: 1 (410) repeat the image before";
  EXPECT_THAT(program("run {} --start 400 --frames 12", images).err, HasSubstr(kNote));
  const std::string window = " --frames 12 --script " + (folder / "script").string();
  EXPECT_THAT(program("snapshot {} --start 400 {}", images, window).out, HasSubstr(kNote));
  EXPECT_THAT(program("snapshot {} --start 200 {}", images, window).out, Not(HasSubstr(kNote)));
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

TEST(SensorCases, AnInterlacedVideoIsAsGoodAsAProgressiveOneByItsFirstFields) {
  const fs::path camcorder = case_folder("interlaced-video"),
                 phone = case_folder("phone-video-kinds");
  SKIP_WITHOUT(camcorder);
  constexpr const char* kNote = "interlaced, top field first: the first field is used";
  EXPECT_THAT(succeeding("info {}", camcorder).out, HasSubstr(kNote));
  const fs::path file = fresh_folder() / "result.json";
  EXPECT_THAT(succeeding("run {} --json {}", camcorder, file).out, HasSubstr(kNote));
  const auto result = read_json(file);
  EXPECT_EQ(result.at("verdict").at("readiness"), "ready");
  // With both fields: ATE 1.5 mm of 0.46 m, scale 1 % and normal 0.55 deg off, 119 inliers.
  const auto& metrics = result.at("metrics");
  EXPECT_LT(metrics.at("ate_m").get<double>(), 0.0005);
  EXPECT_LT(metrics.at("pne_deg").get<double>(), 0.1);
  EXPECT_NEAR(metrics.at("scale").get<double>(), 1, 0.003);
  EXPECT_GT(result.at("window").at("inliers").get<int>(), 170);
  for (const auto& kind : fs::directory_iterator(phone))
    if (kind.is_directory())
      EXPECT_THAT(succeeding("info {}", kind.path()).out, Not(HasSubstr("interlaced"))) << kind;
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

TEST(SensorCases, APosterThatMovesBeforeACameraAtRestIsNoPlane) {
  const fs::path tripod = case_folder("tripod-moving-poster");
  SKIP_WITHOUT(tripod);
  const fs::path file = fresh_folder() / "result.json";
  for (const char* window : {"--frames 16", "--frames 10 --start 5", "--frames 16 --method gpo"}) {
    program("run {} {} --json {}", tripod, window, file);
    const auto result = read_json(file);
    EXPECT_EQ(result.at("verdict").at("readiness"), "degenerate") << window;
    const std::string reason = result.at("verdict").at("reason");
    EXPECT_THAT(reason, HasSubstr("the camera rests, the plane moves")) << window;
    EXPECT_THAT(reason, Not(HasSubstr("longer camera path"))) << window;
  }
}

TEST(SensorCases, RatesInDegreesAndLeftHandedAxesAreNamed) {
  const fs::path given = case_folder("gyroscope-units-and-hands");
  SKIP_WITHOUT(given);
  const fs::path folder = fresh_folder(), left = folder / "left";
  fs::copy(given, left, fs::copy_options::recursive);
  fs::permissions(left / "mav0/imu0/data.csv", fs::perms::owner_write, fs::perm_options::add);
  fs::copy_file(given / "left-handed-data.csv",
                left / "mav0/imu0/data.csv",
                fs::copy_options::overwrite_existing);
  const std::pair<fs::path, const char*> faults[] = {{given, "as in degrees per second"},
                                                     {left, "it fits if its y axis is negated"}};
  for (const auto& [recording, fault] : faults) {
    EXPECT_THAT(program("info {}", recording).out, HasSubstr(fault));
    for (const char* frames : {"10", "16", "20"})
      EXPECT_THAT(program("run {} --frames {}", recording, frames).out, HasSubstr(fault)) << frames;
    expect_exit(
        1, program("calibrate {} --gyroscope --output {}/c.yaml", recording, folder), fault);
    EXPECT_FALSE(fs::exists(folder / "c.yaml"));
  }
  EXPECT_THAT(program("info {}", given).out, HasSubstr("revolutions per second"));
}

}  // namespace
}  // namespace gpo::test
