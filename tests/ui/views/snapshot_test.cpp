// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/snapshot.h"

#include "tests/ui/gl_test.h"
#include "tests/ui/made_inspection.h"

#include <filesystem>

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace gpo {
namespace {

class Snapshot : public DrawingTest {};

/// For people to look at.
void keep(const std::string& name, const cv::Mat& picture) {
  std::filesystem::create_directories(GPO_TEST_OUTPUT_DIR);
  cv::imwrite(std::string(GPO_TEST_OUTPUT_DIR) + "/" + name + ".png", picture);
}

TEST_F(Snapshot, ImageHasTheRecordingsSizeAndTheSameBytesAgain) {
  const Inspection inspection = made_inspection();
  const cv::Mat picture = snapshot_image(inspection, 34);
  keep("image", picture);
  EXPECT_EQ(picture.size(), cv::Size(640, 480));
  if (!on_llvmpipe()) GTEST_SKIP() << "same bytes are promised for llvmpipe only";
  EXPECT_TRUE(same_bytes(picture, snapshot_image(inspection, 34)));
}

TEST_F(Snapshot, SceneHasTheSameBytesAgain) {
  const Inspection inspection = made_inspection({.estimate_error = 2});
  const cv::Mat picture = snapshot_scene(inspection, 24);
  keep("scene", picture);
  EXPECT_EQ(picture.size(), cv::Size(960, 720));
  if (!on_llvmpipe()) GTEST_SKIP() << "same bytes are promised for llvmpipe only";
  EXPECT_TRUE(same_bytes(picture, snapshot_scene(inspection, 24)));
}

TEST_F(Snapshot, DrawsEveryKindOfInspectionWithoutComplaint) {
  keep("image_error",
       snapshot_image(made_inspection({.estimate_error = 3}), 30, {}, {.residuals = true}));
  keep("image_large", snapshot_image(made_inspection(), 20, cv::Size(1280, 720)));
  keep("image_reference", snapshot_image(made_inspection(), 5));
  keep("image_outside", snapshot_image(made_inspection(), 38));
  keep("image_failed", snapshot_image(made_inspection({.ok = false}), 20));
  keep("image_tracks_only",
       snapshot_image(made_inspection({.pictures = false, .truth = false}), 20));
  keep("scene_no_truth", snapshot_scene(made_inspection({.truth = false}), 5));
  keep("scene_failed", snapshot_scene(made_inspection({.ok = false}), 20));
  keep("scene_failed_blind", snapshot_scene(made_inspection({.ok = false, .truth = false}), 20));
  keep("scene_outside", snapshot_scene(made_inspection(), 2, cv::Size(600, 900)));
}

}  // namespace
}  // namespace gpo
