// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/snapshot.h"

#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"

#include <cstdlib>
#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

class Snapshot : public DrawingTest {};

/// Returns the file of an image, for people and for the test that starts another process.
std::filesystem::path kept(const std::string& name) {
  const char* other = std::getenv("GPO_TEST_KEEP");
  return std::filesystem::path(other != nullptr ? other : GPO_TEST_OUTPUT_DIR) / (name + ".png");
}

void keep_snapshot(const std::string& name, const cv::Mat& image) {
  std::filesystem::create_directories(kept(name).parent_path());
  cv::imwrite(kept(name).string(), image);
}

TEST_F(Snapshot, ImageHasTheRecordingsSizeAndTheSameBytesAgain) {
  const Inspection inspection = made_inspection();
  const cv::Mat image = snapshot_image(inspection, 34);
  keep_snapshot("image", image);
  EXPECT_EQ(image.size(), cv::Size(640, 480));
  if (!on_llvmpipe()) GTEST_SKIP() << "bytes are reproducible only with llvmpipe";
  EXPECT_TRUE(same_bytes(image, snapshot_image(inspection, 34)));
}

TEST_F(Snapshot, SceneHasTheSameBytesAgain) {
  const Inspection inspection = made_inspection({.estimate_error = 2});
  const cv::Mat image = snapshot_scene(inspection, 24);
  keep_snapshot("scene", image);
  EXPECT_EQ(image.size(), cv::Size(960, 720));
  if (!on_llvmpipe()) GTEST_SKIP() << "bytes are reproducible only with llvmpipe";
  EXPECT_TRUE(same_bytes(image, snapshot_scene(inspection, 24)));
}

TEST_F(Snapshot, AnotherProcessGivesTheSameBytes) {
  if (!on_llvmpipe()) GTEST_SKIP() << "bytes are reproducible only with llvmpipe";
  const auto folder = std::filesystem::path(GPO_TEST_OUTPUT_DIR) / "another-process";
  std::filesystem::remove_all(folder);
  const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string command = "GPO_TEST_KEEP='" + folder.string() + "' '" + self +
                              "' --gtest_filter='Snapshot.*SameBytesAgain' >/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const cv::Mat image = cv::imread((folder / "image.png").string());
  const cv::Mat scene = cv::imread((folder / "scene.png").string());
  EXPECT_TRUE(same_bytes(snapshot_image(made_inspection(), 34), image));
  EXPECT_TRUE(same_bytes(snapshot_scene(made_inspection({.estimate_error = 2}), 24), scene));
}

TEST_F(Snapshot, UndistortsAsOpenCvDoes) {
  const Inspection inspection = made_inspection({.distorted = true});
  const Camera& camera = inspection.recording->camera;
  const ViewToggles only_image{.tracks = false,
                               .cube = false,
                               .truth = false,
                               .gravity = false,
                               .undistorted = true,
                               .legend = false};
  const cv::Mat drawn = snapshot_image(inspection, 20, {}, {.show = only_image});
  keep_snapshot("image_undistorted", drawn);
  cv::Mat expected;
  const cv::Mat K =
      (cv::Mat_<double>(3, 3) << camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  cv::undistort(inspection.recording->images->bgr(20), expected, K, camera.coefficients);
  cv::Mat difference;
  cv::absdiff(drawn, expected, difference);
  const cv::Scalar mean = cv::mean(difference);
  EXPECT_LT((mean[0] + mean[1] + mean[2]) / 3, 1.5) << "of 255";
}

TEST_F(Snapshot, DrawsEveryKindOfInspectionWithoutMessages) {
  const Inspection tilted = made_inspection({.estimate_error = 3});
  keep_snapshot("image_error", snapshot_image(tilted, 30, {}, {.show = {.residuals = true}}));
  keep_snapshot("image_large", snapshot_image(made_inspection(), 20, cv::Size(1280, 720)));
  keep_snapshot("image_reference", snapshot_image(made_inspection(), 5));
  keep_snapshot("image_outside", snapshot_image(made_inspection(), 38));
  keep_snapshot("image_failed", snapshot_image(made_inspection({.ok = false}), 20));
  const Inspection blind = made_inspection({.images = false, .truth = false});
  keep_snapshot("image_tracks_only", snapshot_image(blind, 20));
  const Inspection uncertain = made_inspection({.estimate_error = 0.5, .normal_sigma_deg = 0.3});
  for (const int times : {0, 1, 10, 100})
    keep_snapshot("scene_uncertain_" + std::to_string(times),
                  snapshot_scene(uncertain, 30, {960, 720}, {.show = {.uncertainty = times}}));
  keep_snapshot("scene_no_truth", snapshot_scene(made_inspection({.truth = false}), 5));
  keep_snapshot("scene_failed", snapshot_scene(made_inspection({.ok = false}), 20));
  keep_snapshot("scene_refused", snapshot_scene(made_inspection({.refused = true}), 20));
  keep_snapshot("scene_failed_blind",
                snapshot_scene(made_inspection({.ok = false, .truth = false}), 20));
  keep_snapshot("scene_outside", snapshot_scene(made_inspection(), 2, cv::Size(600, 900)));
}

/// An image drawn by the program, once.
const cv::Mat& drawn() {
  static const cv::Mat image = snapshot_image(made_inspection(), 20);
  return image;
}

TEST(ImageCompare, AcceptsTheSameImage) {
  const ImageComparison result = compare_images(drawn(), drawn());
  EXPECT_TRUE(result.equal);
  EXPECT_EQ(result.unequal, 0);
  EXPECT_TRUE(result.reason.empty());
}

TEST(ImageCompare, AcceptsTwoLevelsOfRoundingEverywhere) {
  cv::Mat noise(drawn().size(), CV_8SC3), noisy;
  cv::RNG(3).fill(noise, cv::RNG::UNIFORM, -2, 3);
  cv::add(drawn(), noise, noisy, cv::noArray(), CV_8U);
  const ImageComparison result = compare_images(noisy, drawn());
  EXPECT_TRUE(result.equal) << result.reason;
  EXPECT_GT(result.beyond[0], 0);
  EXPECT_EQ(result.beyond[1], 0);
}

TEST(ImageCompare, RejectsACubeMovedByTwoPixels) {
  Inspection moved = made_inspection();
  const double depth = to_camera(moved.initialization->cameras[15], moved.cube->origin).z();
  const double two_px = 2 * depth / moved.recording->camera.fx;
  moved.cube->origin += two_px * moved.cube->axes.col(0);
  const ImageComparison result = compare_images(snapshot_image(moved, 20), drawn());
  EXPECT_FALSE(result.equal);
  EXPECT_NE(result.reason.find("16x16"), std::string::npos) << result.reason;
  EXPECT_EQ(result.difference.size(), drawn().size());
}

TEST(ImageCompare, RejectsSwappedColorsAndAShiftByOnePixel) {
  cv::Mat swapped, shifted = drawn().clone();
  cv::cvtColor(drawn(), swapped, cv::COLOR_BGR2RGB);
  EXPECT_FALSE(compare_images(swapped, drawn()).equal);
  drawn().colRange(0, drawn().cols - 1).copyTo(shifted.colRange(1, drawn().cols));
  EXPECT_FALSE(compare_images(shifted, drawn()).equal);
  cv::Mat green = drawn().clone(), red = drawn().clone();
  const cv::Rect mark(320, 300, 12, 12);
  green(mark) = cv::Scalar(10, 200, 30);
  red(mark) = cv::Scalar(10, 30, 200);
  EXPECT_FALSE(compare_images(red, green).equal);
}

TEST(ImageCompare, RejectsAnotherSizeAndNamesBoth) {
  const ImageComparison result = compare_images(drawn().colRange(0, 100), drawn());
  EXPECT_FALSE(result.equal);
  EXPECT_EQ(result.reason, "size 100x480, expected 640x480");
}

TEST(ImageCompare, ToleranceIsTheLargestDifferenceThatCountsAsEqual) {
  const cv::Mat lighter = drawn() + cv::Scalar::all(10);
  EXPECT_FALSE(compare_images(lighter, drawn(), 9).equal);
  EXPECT_TRUE(compare_images(lighter, drawn(), 10).equal);
}

}  // namespace
}  // namespace gpo
