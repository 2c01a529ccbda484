// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/recording.h"

#include <filesystem>

#include <gtest/gtest.h>

namespace gpo {
namespace {

std::filesystem::path real_recording(const std::string& name) {
  return std::filesystem::path(GPO_SHARED_DIR) / "data" / name;
}

#define SKIP_WITHOUT(folder) \
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << (folder) << " is not on this machine"

TEST(RealRecordings, OpensTheVideoOfAChessboard) {
  const auto folder = real_recording("chessboard-floor");
  SKIP_WITHOUT(folder);
  const auto recording = open_recording(folder);
  EXPECT_EQ(recording->layout, Layout::pictures);
  EXPECT_EQ(recording->frame_count(), 260);
  EXPECT_EQ(recording->pictures->bgr(259).cols, 1280);
  ASSERT_TRUE(recording->board);
  EXPECT_NEAR(1e-9 * (recording->timestamps_ns[24] - recording->timestamps_ns[0]), 1.0, 1e-3);
}

TEST(RealRecordings, OpensTracksWithoutPictures) {
  const auto folder = real_recording("cards-tracks");
  SKIP_WITHOUT(folder);
  const auto recording = open_recording(folder);
  EXPECT_EQ(recording->layout, Layout::tracks);
  EXPECT_EQ(recording->frame_count(), 361);
  EXPECT_EQ(recording->tracks.size(), 18924U);
  EXPECT_EQ(recording->pictures, nullptr);
  ASSERT_TRUE(recording->gyroscope);
  EXPECT_EQ(recording->gyroscope->timestamps_ns.size(), 3685U);
  const Eigen::Vector3d axes = recording->gyroscope->R_gyro_camera.diagonal();
  EXPECT_TRUE(axes.isApprox(Eigen::Vector3d(1, -1, -1), 1e-12));
}

}  // namespace
}  // namespace gpo
