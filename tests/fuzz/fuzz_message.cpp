// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The first byte chooses the encoding and the type.
#include "engine/recording/bags/messages.h"
#include "tests/fuzz/fuzzed_file.h"
#include "tests/fuzz/targets.h"

#include <array>
#include <string>

void gpo::fuzz::fuzz_message(std::string_view bytes) {
  if (bytes.empty()) return;
  const char kind = bytes[0];
  bytes.remove_prefix(1);
  constexpr std::array<const char*, 10> kTypes = {"sensor_msgs/Image",
                                                  "sensor_msgs/CompressedImage",
                                                  gpo::kCameraInfoType,
                                                  gpo::kImuType,
                                                  gpo::kTransformsType,
                                                  "geometry_msgs/PoseStamped",
                                                  "geometry_msgs/PoseWithCovarianceStamped",
                                                  "geometry_msgs/TransformStamped",
                                                  "nav_msgs/Odometry",
                                                  "std_msgs/String"};
  const std::size_t choice = static_cast<unsigned char>(kind) % (2 * kTypes.size());
  const bool cdr = choice >= kTypes.size();
  const gpo::MessageEncoding encoding =
      cdr ? gpo::MessageEncoding::cdr : gpo::MessageEncoding::ros1;
  const std::string type = kTypes[choice % kTypes.size()];
  gpo::fuzz::parse([&] {
    gpo::read_header(bytes, encoding);
    gpo::read_imu(bytes, encoding);
    if (gpo::is_image_type(type)) gpo::bag_image(bytes, {"/camera", type, encoding}, "camera");
    if (const auto pose = gpo::read_pose(bytes, encoding, type)) pose->pose();
    if (type == gpo::kTransformsType) gpo::read_transforms(bytes, encoding);
    if (type != gpo::kCameraInfoType) return;
    const auto info = gpo::read_camera_info(bytes, encoding);
    if (info && gpo::is_calibrated(*info)) gpo::camera_of(*info, "camera");
  });
}
