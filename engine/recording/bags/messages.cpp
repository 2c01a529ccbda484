// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/messages.h"

#include "engine/recording/bags/message_cursor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace gpo {
namespace {

/// How the types of poses begin after their header.
struct PoseType {
  const char* type;
  bool has_child;
};
constexpr std::array<PoseType, 4> kPoseTypes = {{{"geometry_msgs/PoseStamped", false},
                                                 {"geometry_msgs/PoseWithCovarianceStamped", false},
                                                 {"geometry_msgs/TransformStamped", true},
                                                 {"nav_msgs/Odometry", true}}};

template <class Message>
std::optional<Message> if_whole(const MessageCursor& cursor, Message message) {
  return cursor.ok() ? std::optional(std::move(message)) : std::nullopt;
}

std::int64_t time_ns(MessageCursor& cursor) {
  // ROS 2 has signed seconds.
  const std::int64_t seconds =
      cursor.ros1() ? std::int64_t{cursor.number<std::uint32_t>()} : cursor.number<std::int32_t>();
  return seconds * 1'000'000'000 + cursor.number<std::uint32_t>();
}

MessageHeader header(MessageCursor& cursor) {
  if (cursor.ros1()) cursor.number<std::uint32_t>();  // seq
  const std::int64_t stamp_ns = time_ns(cursor);
  return {stamp_ns, cursor.text()};
}

PoseMessage pose(MessageCursor& cursor, bool has_child) {
  PoseMessage message;
  message.header = header(cursor);
  if (has_child) message.child_frame_id = cursor.text();
  message.position = cursor.vector();
  for (double& value : message.quaternion_xyzw) value = cursor.number<double>();
  return message;
}

}  // namespace

std::optional<Pose> PoseMessage::pose() const {
  if (!(std::abs(quaternion_xyzw.norm() - 1) <= 1e-2) || !position.allFinite()) return std::nullopt;
  return Pose{Eigen::Quaterniond(quaternion_xyzw).normalized().toRotationMatrix(), position};
}

bool is_picture_type(const std::string& type) {
  return type == "sensor_msgs/Image" || type == "sensor_msgs/CompressedImage";
}

bool is_pose_type(const std::string& type) {
  return std::ranges::any_of(kPoseTypes, [&](const PoseType& one) { return type == one.type; });
}

std::optional<MessageHeader> read_header(std::string_view bytes, MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  MessageHeader message = header(cursor);
  return if_whole(cursor, std::move(message));
}

std::optional<ImageMessage> read_image(std::string_view bytes, MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  ImageMessage message;
  message.header = header(cursor);
  message.height = cursor.number<std::uint32_t>();
  message.width = cursor.number<std::uint32_t>();
  message.encoding = cursor.text();
  message.big_endian = cursor.number<std::uint8_t>() != 0;
  message.step = cursor.number<std::uint32_t>();
  message.data = cursor.bytes();
  return if_whole(cursor, std::move(message));
}

std::optional<CompressedImageMessage> read_compressed_image(std::string_view bytes,
                                                            MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  CompressedImageMessage message;
  message.header = header(cursor);
  message.format = cursor.text();
  message.data = cursor.bytes();
  return if_whole(cursor, std::move(message));
}

std::optional<CameraInfoMessage> read_camera_info(std::string_view bytes,
                                                  MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  CameraInfoMessage message;
  message.header = header(cursor);
  message.height = cursor.number<std::uint32_t>();
  message.width = cursor.number<std::uint32_t>();
  message.distortion_model = cursor.text();
  message.D = cursor.doubles();
  message.K = cursor.doubles(9);
  return if_whole(cursor, std::move(message));
}

std::optional<ImuMessage> read_imu(std::string_view bytes, MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  ImuMessage message;
  message.header = header(cursor);
  cursor.doubles(4 + 9);  // orientation, its covariance
  message.angular_velocity = cursor.vector();
  cursor.doubles(9);
  message.linear_acceleration = cursor.vector();
  return if_whole(cursor, std::move(message));
}

std::optional<PoseMessage> read_pose(std::string_view bytes,
                                     MessageEncoding encoding,
                                     const std::string& type) {
  const auto known =
      std::ranges::find_if(kPoseTypes, [&](const PoseType& one) { return type == one.type; });
  if (known == kPoseTypes.end()) return std::nullopt;
  MessageCursor cursor(bytes, encoding);
  PoseMessage message = pose(cursor, known->has_child);
  return if_whole(cursor, std::move(message));
}

std::optional<std::vector<PoseMessage>> read_transforms(std::string_view bytes,
                                                        MessageEncoding encoding) {
  MessageCursor cursor(bytes, encoding);
  const auto count = cursor.number<std::uint32_t>();
  std::vector<PoseMessage> transforms;
  for (std::uint32_t i = 0; i < count && cursor.ok(); ++i) transforms.push_back(pose(cursor, true));
  return if_whole(cursor, std::move(transforms));
}

}  // namespace gpo
