// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/recording.h"
#include "ui/panels/facts/facts.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::HasSubstr;

Recording recorded() {
  Recording recording;
  recording.camera = Camera{640, 480, 500, 500, 319.5, 239.5, Distortion::radial_tangential, {}};
  recording.camera.coefficients = {-0.2, 0.05, 0, 0};
  recording.camera.sigmas = {1.5, 1.5, 20, 2, 0.01, 0.01, 0, 0};
  for (int i = 0; i < 30; ++i)
    recording.timestamps_ns.push_back(std::int64_t{33'000'000} * (i < 20 ? i : i + 10));
  return recording;
}

ResultRow row_of(const Recording& recording, const std::string& label) {
  for (const ResultGroup& group : recording_groups(recording))
    for (const ResultRow& row : group.rows)
      if (row.label == label) return row;
  throw std::out_of_range(label);
}

TEST(CameraFacts, HaveUncertaintiesAndTheFieldOfView) {
  Recording recording = recorded();
  EXPECT_EQ(row_of(recording, "fx").value, "500.00 \u00b11.5 px");
  recording.camera.sigmas.front() = 0;
  EXPECT_EQ(row_of(recording, "fx").value, "500.00 px exact");
  EXPECT_EQ(row_of(recording, "Image").value, "640\u00d7480 px");
  recording.camera.distortion = Distortion::none;
  recording.camera.coefficients.clear();
  recording.camera.sigmas.clear();
  // 2 atan(320 / 500) and 2 atan(240 / 500)
  EXPECT_EQ(row_of(recording, "Field of view").value, "65.2\u00b0 \u00d7 51.3\u00b0");
  EXPECT_EQ(row_of(recording, "Field of view").note, "diagonal 77.3\u00b0");
  EXPECT_EQ(row_of(recording, "fx").value, "500.00 px");
}

TEST(CameraFacts, SayThatAPrincipalPointIsFromItsPriorOnly) {
  Recording recording = recorded();
  EXPECT_EQ(row_of(recording, "cx").note, "") << "a calibration file states what it states";
  recording.camera_source = CameraSource::self_calibrated;
  EXPECT_EQ(row_of(recording, "cx").note, "prior only");
  EXPECT_THAT(row_of(recording, "cx").tooltip, HasSubstr("The images do not determine it"));
  EXPECT_EQ(row_of(recording, "cy").note, "");
}

TEST(CameraFacts, HaveGapsAndSensors) {
  Recording recording = recorded();
  EXPECT_EQ(row_of(recording, "Frame gaps").value, "1 gap");
  EXPECT_EQ(row_of(recording, "Frame gaps").note, "longest 0.363 s at 0.63 s");
  EXPECT_EQ(row_of(recording, "Gyroscope").tooltip, "The recording has none");
  recording.gyroscope = Gyroscope{};
  recording.gyroscope->time_offset_ns = -2'500'000;
  for (int i = -200; i < 200; ++i)
    recording.gyroscope->timestamps_ns.push_back(std::int64_t{5'000'000} * i);
  EXPECT_EQ(row_of(recording, "Rate").value, "200 Hz");
  EXPECT_EQ(row_of(recording, "Clock").value, "-2.50 ms");
  EXPECT_EQ(row_of(recording, "Sample gaps").value, "none");
  recording.gyroscope->timestamps_ns.back() += 100'000'000;
  EXPECT_EQ(row_of(recording, "Sample gaps").note, "longest 0.105 s at 0.99 s");
  recording.truth = GroundTruth{"poses.csv", {std::nullopt, Pose{}}};
  recording.truth->jumps = {{660'000'000, 693'000'000, 12.5, 0.3}};
  EXPECT_EQ(row_of(recording, "Ground truth").value, "1 pose");
  EXPECT_EQ(row_of(recording, "Truth jumps").note, "first 12.5\u00b0, 0.300 m at 0.66 s");
}

TEST(CameraFacts, ShowWhatACalibrationChanged) {
  const Camera after = recorded().camera;
  const Camera before{640, 480, 480, 480, 319.5, 239.5, Distortion::none, {}};
  const auto rows = calibration_changes(before, after);
  ASSERT_EQ(rows.size(), 8U);
  EXPECT_EQ(rows[0].value, "480.00 \u2192 500.00 \u00b11.5 px");
  EXPECT_EQ(rows[0].note, "+20.00");
  EXPECT_EQ(rows[4].value, "0.00000 \u2192 -0.20000 \u00b10.01");
}

TEST(DistortionGrid, IsRegularWithoutDistortionAndBentWithIt) {
  Camera camera = recorded().camera;
  const auto bend_px = [](const std::vector<Eigen::Vector2d>& line) {
    const Eigen::Vector2d along = (line.back() - line.front()).normalized();
    double most = 0;
    for (const Eigen::Vector2d& at : line) {
      const Eigen::Vector2d from = at - line.front();
      most = std::max(most, std::abs(along.x() * from.y() - along.y() * from.x()));
    }
    return most;
  };
  EXPECT_GT(bend_px(distortion_grid(camera, 16).front()), 5);
  camera.distortion = Distortion::none;
  camera.coefficients.clear();
  const auto lines = distortion_grid(camera, 16);
  EXPECT_EQ(lines.size(), 17U + 13U);
  for (const auto& line : lines) EXPECT_LT(bend_px(line), 1e-9);
}

}  // namespace
}  // namespace gpo
