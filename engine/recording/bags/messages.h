// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/recording/bags/containers/bag.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

// The messages of ROS that a recording is made of, as ROS names their fields. What reads them
// returns nothing where the bytes are cut, or not encoded as the topic says. Of names that point
// into the message's bytes it is said.

struct MessageHeader {
  std::int64_t stamp_ns = 0;  ///< 0: the sender did not say
  std::string frame_id;
};

/// sensor_msgs/Image
struct ImageMessage {
  MessageHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;  ///< "mono8"
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes a row
  std::string_view data;   ///< in the message's bytes
};

/// sensor_msgs/CompressedImage
struct CompressedImageMessage {
  MessageHeader header;
  std::string format;     ///< "jpeg", and more
  std::string_view data;  ///< a file of a picture, in the message's bytes
};

/// sensor_msgs/CameraInfo, as far as it is the calibration
struct CameraInfoMessage {
  MessageHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;  ///< "plumb_bob"
  std::vector<double> D;
  std::vector<double> K;  ///< 9, row by row
};

/// sensor_msgs/Imu, without its orientation
struct ImuMessage {
  MessageHeader header;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();     ///< [rad/s]
  Eigen::Vector3d linear_acceleration = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// geometry_msgs/PoseStamped, PoseWithCovarianceStamped and TransformStamped, nav_msgs/Odometry:
/// where something is in the frame of the header.
struct PoseMessage {
  MessageHeader header;
  std::string child_frame_id;  ///< what is there; empty: the type has no such field
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector4d quaternion_xyzw = Eigen::Vector4d::Zero();

  /// Nothing where the quaternion is no rotation.
  std::optional<Pose> pose() const;
};

bool is_image_type(const std::string& type);
bool is_pose_type(const std::string& type);
inline constexpr const char* kCameraInfoType = "sensor_msgs/CameraInfo";
inline constexpr const char* kImuType = "sensor_msgs/Imu";
inline constexpr const char* kTransformsType = "tf2_msgs/TFMessage";

/// Of all types above the first field; needs only the beginning of the message.
std::optional<MessageHeader> read_header(std::string_view bytes, MessageEncoding encoding);
std::optional<ImageMessage> read_image(std::string_view bytes, MessageEncoding encoding);
std::optional<CompressedImageMessage> read_compressed_image(std::string_view bytes,
                                                            MessageEncoding encoding);
std::optional<CameraInfoMessage> read_camera_info(std::string_view bytes, MessageEncoding encoding);
std::optional<ImuMessage> read_imu(std::string_view bytes, MessageEncoding encoding);
std::optional<PoseMessage> read_pose(std::string_view bytes,
                                     MessageEncoding encoding,
                                     const std::string& type);
/// tf2_msgs/TFMessage
std::optional<std::vector<PoseMessage>> read_transforms(std::string_view bytes,
                                                        MessageEncoding encoding);

/// Whether somebody calibrated it: ROS' drivers send zeros otherwise.
bool is_calibrated(const CameraInfoMessage& info);

/// Throws InputError that begins with `name` where it is no camera that we know.
Camera camera_of(const CameraInfoMessage& info, const std::string& name);

/// What `camera_of` reads; without its header.
CameraInfoMessage camera_info_of(const Camera& camera);

/// T_from_to, x_from = R x_to + p, along transforms that are known, in either direction; nothing
/// where they do not connect the two.
std::optional<Pose> transform_between(const std::vector<PoseMessage>& transforms,
                                      const std::string& from,
                                      const std::string& to);

}  // namespace gpo
