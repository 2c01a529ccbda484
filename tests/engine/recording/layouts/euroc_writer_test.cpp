// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/layouts/open_recording.h"
#include "engine/recording/layouts/write_recording.h"
#include "engine/truth/truth.h"
#include "engine/window/gyroscope.h"
#include "tests/engine/test_folder.h"

#include <Eigen/Geometry>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::error_of;
using test::TestFolder;
using testing::HasSubstr;

/// Returns a complete recording with numbers that need all digits.
Recording everything() {
  Recording recording;
  recording.camera = {
      64, 48, 60.1, 61.7, 31.3, 23.9, Distortion::equidistant, {0.1, -1e-3, 0, 1e-7}};
  recording.T_body_camera =
      Pose{Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, 2, -3).normalized()).matrix(),
           {0.1, -0.2, 1.0 / 3}};
  recording.timestamps_ns = {
      1403636579000000001, 1403636579033333334, 1403636579066666668, 1403636579100000001};
  recording.images = std::make_shared<const FrameCache>(4, [](int i) {
    cv::Mat image(48, 64, CV_8UC3, cv::Scalar(10 * i, 20, i == 2 ? 20 : 70));
    if (i == 3) image.setTo(cv::Scalar::all(99));
    return image;
  });
  Gyroscope gyroscope;
  for (int i = 0; i < 30; ++i) {
    gyroscope.timestamps_ns.push_back(1403636578999999999 + i * 5000000LL);
    gyroscope.rates_rad_s.emplace_back(0.1 / 3, -0.2 * i, 1e-9);
    gyroscope.accelerations_m_s2.emplace_back(0, 9.81 / 7, i);
  }
  gyroscope.R_gyro_camera = Eigen::AngleAxisd(-1, Eigen::Vector3d::UnitY()).matrix();
  gyroscope.time_offset_ns = -2345678;
  gyroscope.bias_rad_s = {0.001, 1.0 / 3000, -0.002};
  gyroscope.bias_sigma_rad_s = 0.0123;
  gyroscope.noise_density = 1.0 / 7000;
  recording.gyroscope = gyroscope;
  recording.plane = Plane{Eigen::Vector3d(1, 2, 3).normalized(), 0.7};
  recording.board = Board{9, 6, 0.025};
  return recording;
}

GroundTruth truth_with_a_gap() {
  GroundTruth truth{"made", {}};
  for (int i = 0; i < 4; ++i)
    truth.poses.push_back(
        Pose{Eigen::AngleAxisd(0.3 * i, Eigen::Vector3d::UnitX()).matrix(), {0.1 * i, 1.0 / 7, 0}});
  truth.poses[1].reset();
  return truth;
}

TEST(EurocWriter, WritesARecordingThatOpensAsTheSame) {
  const TestFolder folder;
  const Recording recording = everything();
  const GroundTruth truth = truth_with_a_gap();
  write_euroc(recording, truth, folder.path() / "out");
  const auto read = open_recording(folder.path() / "out");
  EXPECT_EQ(read->layout, "EuRoC");
  EXPECT_EQ(read->camera, recording.camera);
  EXPECT_EQ(read->timestamps_ns, recording.timestamps_ns);
  EXPECT_TRUE(read->T_body_camera->R_wc.isApprox(recording.T_body_camera->R_wc, 1e-14));
  for (int i = 0; i < 4; ++i)
    EXPECT_EQ(cv::norm(read->images->bgr(i), recording.images->bgr(i), cv::NORM_INF), 0);
  ASSERT_TRUE(read->gyroscope);
  EXPECT_EQ(read->gyroscope->timestamps_ns, recording.gyroscope->timestamps_ns);
  EXPECT_EQ(read->gyroscope->rates_rad_s, recording.gyroscope->rates_rad_s);
  EXPECT_EQ(read->gyroscope->accelerations_m_s2, recording.gyroscope->accelerations_m_s2);
  EXPECT_TRUE(read->gyroscope->R_gyro_camera.isApprox(recording.gyroscope->R_gyro_camera, 1e-14));
  EXPECT_EQ(read->gyroscope->time_offset_ns, recording.gyroscope->time_offset_ns);
  EXPECT_EQ(read->gyroscope->bias_rad_s, recording.gyroscope->bias_rad_s);
  EXPECT_EQ(read->gyroscope->bias_sigma_rad_s, recording.gyroscope->bias_sigma_rad_s);
  EXPECT_EQ(read->gyroscope->noise_density, recording.gyroscope->noise_density);
  ASSERT_TRUE(read->truth);
  for (int i = 0; i < 4; ++i) {
    ASSERT_EQ(read->truth->poses[i].has_value(), truth.poses[i].has_value()) << i;
    if (!truth.poses[i]) continue;
    EXPECT_TRUE(read->truth->poses[i]->R_wc.isApprox(truth.poses[i]->R_wc, 1e-13));
    EXPECT_LT((read->truth->poses[i]->p_wc - truth.poses[i]->p_wc).norm(), 1e-13);
  }
  EXPECT_TRUE(read->plane->normal.isApprox(recording.plane->normal, 1e-14));
  EXPECT_EQ(read->board->columns, 9);
}

TEST(EurocWriter, KeepsTracksWithoutImages) {
  const TestFolder folder;
  Recording recording = everything();
  recording.images = nullptr;
  recording.tracks = {{0, 7, {1.0 / 3, 2}}, {2, 7, {4, 5}}, {3, 9, {6, 7}}};
  write_euroc(recording, std::nullopt, folder.path() / "out");
  const auto read = open_recording(folder.path() / "out");
  EXPECT_EQ(read->layout, "tracks");
  EXPECT_FALSE(read->truth);
  ASSERT_EQ(read->tracks.size(), 3U);
  EXPECT_EQ(read->tracks[0].raw_px.x(), 1.0 / 3);
  EXPECT_EQ(read->tracks[2].track, 9);
}

TEST(EurocWriter, LeavesNoFilesAfterAFailure) {
  const TestFolder folder;
  Recording recording = everything();
  recording.images = std::make_shared<const FrameCache>(4, [](int i) -> cv::Mat {
    if (i == 2) throw InputError("frame 2 is broken");
    return {48, 64, CV_8UC3, cv::Scalar::all(i)};
  });
  EXPECT_EQ(error_of([&] { write_euroc(recording, {}, folder.path() / "out"); }),
            "frame 2 is broken");
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  folder.write("full/file", "");
  EXPECT_THAT(error_of([&] { write_euroc(everything(), {}, folder.path() / "full"); }),
              HasSubstr("full: is not empty; choose a new or empty folder"));
}

}  // namespace
}  // namespace gpo
