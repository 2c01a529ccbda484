// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/save_window.h"

#include "engine/inspection/inspector.h"
#include "engine/recording/layouts/open_recording.h"
#include "tests/engine/desk.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

namespace fs = std::filesystem;

/// Fails if the program's result of a saved window differs from the library's.
void expect_close(const Initialization& read, const Initialization& ours) {
  ASSERT_TRUE(ours.ok) << ours.reason;
  ASSERT_TRUE(read.ok) << read.reason;
  EXPECT_LT((read.plane.normal - ours.plane.normal).norm(), 1e-9);
  ASSERT_EQ(read.cameras.size(), ours.cameras.size());
  for (std::size_t i = 0; i < ours.cameras.size(); ++i) {
    EXPECT_LT((read.cameras[i].p_wc - ours.cameras[i].p_wc).norm(), 1e-9) << i;
    EXPECT_LT((read.cameras[i].R_wc - ours.cameras[i].R_wc).norm(), 1e-9) << i;
  }
  EXPECT_EQ(read.points.size(), ours.points.size());
  EXPECT_NEAR(read.uncertainty->normal_sigma_deg, ours.uncertainty->normal_sigma_deg, 1e-9);
  EXPECT_EQ(read.verdict->readiness, ours.verdict->readiness);
}

std::shared_ptr<const Inspection> opened_window(const fs::path& folder,
                                                int frames,
                                                const OpenOptions& options = {}) {
  return Inspector(open_recording(folder, options)).inspect({.frames = frames});
}

TEST(SaveWindow, GivesTheSameResultInTheProgramWithCameraImuAndSigmas) {
  const TestFolder folder;
  const auto recording = desk();
  const auto inspection = Inspector(recording).inspect({.frames = 20});
  std::vector<Frame> frames = frames_of(*inspection);
  for (Frame& frame : frames) {
    frame.sigma_px.resize(std::ssize(frame.ids));
    for (Eigen::Index k = 0; k < frame.sigma_px.size(); ++k)
      frame.sigma_px[k] = frame.ids[k] % 3 == 0 ? 0.4 : 0.25;
  }
  Camera camera = recording->camera;
  camera.readout = Readout{0.001, 0.0005};
  const Eigen::Vector3d p_gyro_camera_m(0.01, -0.02, 0.03);
  const WindowResult ours =
      initialize(camera, frames, &*recording->gyroscope, {.p_gyro_camera_m = p_gyro_camera_m});
  save_window(folder.path() / "window",
              camera,
              frames,
              &*recording->gyroscope,
              {.p_gyro_camera_m = p_gyro_camera_m});
  const auto read = opened_window(folder.path() / "window", 20);
  EXPECT_EQ(read->recording->camera, camera);
  expect_close(*read->initialization, ours.initialization);
  ASSERT_TRUE(ours.inertial && read->inertial);
  EXPECT_NEAR(read->inertial->scale, ours.inertial->scale, 1e-9);
}

TEST(SaveWindow, WritesImagesAndTracksWithoutAGyroscope) {
  const TestFolder folder;
  const auto simulation = simulate({.frames = 10, .reference_noise_px = 0.5});
  const Camera camera = camera_of(simulation.window);
  const std::vector<Frame> frames = frames_of(simulation.window);
  const std::vector<cv::Mat> images(10, cv::Mat(480, 640, CV_8UC1, cv::Scalar::all(77)));
  save_window(folder.path() / "window", camera, frames, nullptr, {.images = images});
  const fs::path tracks = folder.path() / "window" / "tracks.csv";
  const auto read = opened_window(folder.path() / "window", 10, {.tracks = tracks});
  EXPECT_EQ(read->recording->images->gray(9).at<uchar>(100, 100), 77);
  expect_close(*read->initialization, initialize(camera, frames).initialization);
}

TEST(SaveWindow, RejectsInputThatCouldNotBeOpened) {
  const TestFolder folder;
  const auto simulation = simulate({.frames = 4});
  const std::vector<Frame> frames = frames_of(simulation.window);
  Camera camera = camera_of(simulation.window);
  const auto error = [&](const WindowExtras& extras = {}) {
    return error_of([&] { save_window(folder.path() / "w", camera, frames, nullptr, extras); });
  };
  EXPECT_EQ(error({.images = {cv::Mat(480, 640, CV_8UC1)}}),
            "1 image and 4 frames, expected equal counts or no images");
  EXPECT_EQ(error({.images = std::vector<cv::Mat>(4, cv::Mat(240, 320, CV_8UC1))}),
            "an image of 320x240, expected 640x480 with 8 bits");
  camera.width = 0;
  EXPECT_EQ(error(), "camera: 0x480, expected the size of the images");
  EXPECT_FALSE(fs::exists(folder.path() / "w"));
}

}  // namespace
}  // namespace gpo::test
