// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/messages.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gpo::test {

inline constexpr std::int64_t kStart_ns = 1'403'715'286'762'142'976;
inline constexpr std::int64_t kPeriod_ns = 50'000'000;

/// Returns incompressible pixels that differ between images.
inline std::string pixels_of(int image, int width, int height, int channels = 1) {
  std::string pixels;
  auto noise = static_cast<std::uint32_t>(image);
  for (int i = 0; i < width * height * channels; ++i) {
    noise = noise * 1'664'525 + 1'013'904'223;
    pixels += static_cast<char>(noise >> 24);
  }
  return pixels;
}

inline ImageMessage image_of(int image, const std::string& pixels, int width, int height) {
  return {{kStart_ns + image * kPeriod_ns, "cam0"},
          static_cast<std::uint32_t>(height),
          static_cast<std::uint32_t>(width),
          "mono8",
          false,
          static_cast<std::uint32_t>(width),
          pixels};
}

inline Camera small_camera() {
  Camera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx = 60.25;
  camera.fy = 61;
  camera.cx = 31;
  camera.cy = 23.5;
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = {0.1, -0.02, 1e-3, 2e-3};
  return camera;
}

inline std::string camera_info_of(MessageEncoding encoding, const Camera& camera) {
  CameraInfoMessage info = gpo::camera_info_of(camera);
  info.header = {kStart_ns, "cam0"};
  return camera_info_bytes(info, encoding);
}

using OpenWriter =
    std::function<BagWriter(const std::filesystem::path&, const std::vector<BagTopic>&)>;

/// Writes a bag with images of 64x48, calibration, gyroscope, truth and the transforms between
/// them, recorded 3 ms after each message's time stamp.
inline std::filesystem::path write_small_bag(const std::filesystem::path& file,
                                             const OpenWriter& open,
                                             int images = 20) {
  const BagWriter writer = open(file,
                                {{"/cam0/image_raw", "sensor_msgs/Image"},
                                 {"/cam0/camera_info", "sensor_msgs/CameraInfo"},
                                 {"/imu0", "sensor_msgs/Imu"},
                                 {"/truth", "geometry_msgs/TransformStamped"},
                                 {"/tf_static", "tf2_msgs/TFMessage"}});
  const MessageEncoding encoding = writer.encoding;
  const auto write = [&](int topic, std::int64_t time, const std::string& bytes) {
    writer.write(topic, time + 3'000'000, bytes);
  };
  const Eigen::Vector4d turned(0, 0, 0.6, 0.8);
  write(1, kStart_ns, camera_info_of(encoding, small_camera()));
  write(4,
        kStart_ns,
        transforms_bytes({{{kStart_ns, "imu0"}, "cam0", {0.1, 0.2, 0.3}, turned},
                          {{kStart_ns, "marker"}, "imu0", {1, 0, 0}, {0, 0, 0, 1}}},
                         encoding));
  for (int i = 0; i < images; ++i) {
    const std::int64_t time = kStart_ns + i * kPeriod_ns;
    write(0, time, image_bytes(image_of(i, pixels_of(i, 64, 48), 64, 48), encoding));
    const Eigen::Vector3d rate(0.1 * i, 0.2, 0.3), acceleration(0, 0, 9.81);
    write(2, time, imu_bytes({{time, "imu0"}, rate, acceleration}, encoding));
    write(3,
          time,
          transform_bytes({{time, "world"}, "marker", {0.5 * i, 2, 3}, {0, 0, 0, 1}}, encoding));
  }
  writer.finish();
  return file;
}

}  // namespace gpo::test
