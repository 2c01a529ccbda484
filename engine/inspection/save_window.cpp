// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/save_window.h"

#include "engine/base/error.h"
#include "engine/pipeline/pipeline.h"
#include "engine/recording/layouts/write_recording.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

void check_saved(const Camera& camera,
                 std::span<const Frame> frames,
                 const Gyroscope* gyroscope,
                 const WindowExtras& extras) {
  check_camera(camera);
  if (camera.width < 1 || camera.height < 1)
    throw InputError(
        fmt::format("camera: {}x{}, expected the size of the images", camera.width, camera.height));
  for (std::size_t i = 0; i < frames.size(); ++i)
    check_frame(frames[i],
                static_cast<int>(i),
                i > 0 ? &frames[i - 1] : nullptr,
                gyroscope != nullptr ? gyroscope->time_offset_ns : 0);
  if (gyroscope != nullptr) check_gyroscope(*gyroscope);
  if (!extras.images.empty() && extras.images.size() != frames.size())
    throw InputError(fmt::format("{} and {}, expected equal counts or no images",
                                 counted(extras.images.size(), "image"),
                                 counted(frames.size(), "frame")));
  for (const cv::Mat& image : extras.images)
    if (image.size() != cv::Size(camera.width, camera.height) || image.depth() != CV_8U)
      throw InputError(fmt::format("an image of {}x{}, expected {}x{} with 8 bits",
                                   image.cols,
                                   image.rows,
                                   camera.width,
                                   camera.height));
}

std::shared_ptr<const FrameCache> cache_of(const std::vector<cv::Mat>& images) {
  if (images.empty()) return nullptr;
  return std::make_shared<const FrameCache>(static_cast<int>(images.size()), [&images](int i) {
    if (images[i].channels() == 3) return images[i].clone();
    cv::Mat bgr;
    cv::cvtColor(images[i], bgr, cv::COLOR_GRAY2BGR);
    return bgr;
  });
}

}  // namespace

void save_window(const std::filesystem::path& folder,
                 const Camera& camera,
                 std::span<const Frame> frames,
                 const Gyroscope* gyroscope,
                 const WindowExtras& extras) {
  check_saved(camera, frames, gyroscope, extras);
  Recording recording;
  recording.path = folder;
  recording.camera = camera;
  recording.tracks = observations_of(frames);
  recording.images = cache_of(extras.images);
  for (const Frame& frame : frames) recording.timestamps_ns.push_back(frame.timestamp_ns);
  if (gyroscope != nullptr) {
    recording.gyroscope = *gyroscope;
    recording.T_body_camera =
        Pose{gyroscope->R_gyro_camera, extras.p_gyro_camera_m.value_or(Eigen::Vector3d::Zero())};
  }
  write_recording(recording, std::nullopt, RecordingFormat::euroc, folder);
}

}  // namespace gpo
