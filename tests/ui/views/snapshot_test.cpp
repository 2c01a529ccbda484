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

}  // namespace
}  // namespace gpo
