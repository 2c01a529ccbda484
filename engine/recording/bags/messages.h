// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/recording/bags/containers/bag.h"

#include <opencv2/core.hpp>

namespace gpo {

// ROS messages, with ROS' names. Readers return nullopt if the bytes are truncated or differ.

struct MessageHeader {
  std::int64_t stamp_ns = 0;  ///< 0 if unknown
  std::string frame_id;
};

struct ImageMessage {
  MessageHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;  ///< "mono8"
  bool big_endian = false;
  std::uint32_t step = 0;  ///< bytes a row
  std::string_view data;   ///< points into the message's bytes
};

struct CameraInfoMessage {
  MessageHeader header;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;  ///< "plumb_bob"
  std::vector<double> D;
  std::vector<double> K;  ///< 3 x 3, row by row
};

struct ImuMessage {
  MessageHeader header;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();     ///< [rad/s]
  Eigen::Vector3d linear_acceleration = Eigen::Vector3d::Zero();  ///< [m/s^2]
};

/// geometry_msgs/PoseStamped, ...WithCovarianceStamped, TransformStamped, or nav_msgs/Odometry.
struct PoseMessage {
  MessageHeader header;
  std::string child_frame_id;  ///< the frame with this pose; empty if the type has no such field
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector4d quaternion_xyzw = Eigen::Vector4d::Zero();

  std::optional<Pose> pose() const;
};

bool is_image_type(const std::string& type);
bool is_pose_type(const std::string& type);
inline constexpr const char* kCameraInfoType = "sensor_msgs/CameraInfo";
inline constexpr const char* kImuType = "sensor_msgs/Imu";
inline constexpr const char* kTransformsType = "tf2_msgs/TFMessage";

std::optional<MessageHeader> read_header(std::string_view bytes, MessageEncoding encoding);
std::optional<ImageMessage> read_image(std::string_view bytes, MessageEncoding encoding);
/// Returns the image file in a sensor_msgs/CompressedImage, a part of `bytes`.
std::optional<std::string_view> read_compressed_image(std::string_view bytes,
                                                      MessageEncoding encoding);
std::optional<CameraInfoMessage> read_camera_info(std::string_view bytes, MessageEncoding encoding);
std::optional<ImuMessage> read_imu(std::string_view bytes, MessageEncoding encoding);
std::optional<PoseMessage> read_pose(std::string_view bytes,
                                     MessageEncoding encoding,
                                     const std::string& type);
std::optional<std::vector<PoseMessage>> read_transforms(std::string_view bytes,
                                                        MessageEncoding encoding);

/// False for the zeros that ROS' drivers send without a calibration.
bool is_calibrated(const CameraInfoMessage& info);

/// Throws InputError that begins with `name` if the camera is not supported.
Camera camera_of(const CameraInfoMessage& info, const std::string& name);

CameraInfoMessage camera_info_of(const Camera& camera);

/// x_from = R x_to + p along the transforms in either direction; nullopt if they do not connect.
std::optional<Pose> transform_between(const std::vector<PoseMessage>& transforms,
                                      const std::string& from,
                                      const std::string& to);

/// Decodes blue, green, red, 8 or 16 bits each. Throws InputError that begins with `name`.
cv::Mat bag_image(std::string_view bytes, const BagTopic& topic, const std::string& name);

struct BagWriter {
  MessageEncoding encoding;  ///< required for the messages
  std::function<void(int topic, std::int64_t time_ns, const std::string& bytes)> write;
  std::function<void()> finish;
};

/// ROS 1 with uncompressed chunks of 768 KiB. `message_type` must know the topics' types.
BagWriter ros1_writer(const fs::path& file, const std::vector<BagTopic>& topics);

BagWriter mcap_writer(const fs::path& file, const std::vector<BagTopic>& topics);

std::string image_bytes(const ImageMessage& message, MessageEncoding encoding);
/// The rectified camera has the same matrix without distortion.
std::string camera_info_bytes(const CameraInfoMessage& message, MessageEncoding encoding);
std::string imu_bytes(const ImuMessage& message, MessageEncoding encoding);
std::string transform_bytes(const PoseMessage& message, MessageEncoding encoding);
std::string transforms_bytes(const std::vector<PoseMessage>& messages, MessageEncoding encoding);

struct MessageType {
  const char* ros1_sum;    ///< MD5 of the definition
  std::string definition;  ///< its fields, and those of the types of its fields
};

/// Knows the types above. Throws std::out_of_range for others.
MessageType message_type(const std::string& name, MessageEncoding encoding);

enum class TopicRole { image, camera_info, imu, truth };
inline constexpr int kTopicRoles = 4;
template <>
struct ChoiceKeys<TopicRole> {
  static constexpr const char* name = "topic";
  static constexpr std::array<const char*, kTopicRoles> keys = {
      "image", "camera_info", "imu", "truth"};
};

using TopicChoices = std::map<TopicRole, std::string>;

/// Parses "image=/cam0/image_raw", one text for each role. Throws SettingError.
TopicChoices parse_topic_choices(const std::vector<std::string>& texts);

struct TopicRoles {
  std::array<std::optional<int>, kTopicRoles> topics;  ///< indices in `Bag::topics`
  std::vector<std::string> notes;                      ///< "several topics with ..."

  std::optional<int> of(TopicRole role) const { return topics[static_cast<std::size_t>(role)]; }
};

/// Finds a topic for each role: the chosen one, else that with the images' longest common prefix,
/// `depth` or `accel` last. Throws InputError if there are no images or a chosen topic is missing.
TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices);

std::string topics_text(const Bag& bag);

/// Sorted by the messages' own time stamps, or else those of recording, strictly ascending.
struct BagContents {
  std::vector<std::int64_t> image_times_ns;
  std::vector<BagMessage> images;                ///< one for each time
  std::string camera_frame;                      ///< `frame_id` of the first image
  std::optional<CameraInfoMessage> camera_info;  ///< the first
  std::vector<ImuMessage> imu;
  std::vector<PoseMessage> truth;
  std::vector<PoseMessage> transforms;  ///< from /tf_static
  std::vector<std::string> notes;       ///< about ignored messages
};

/// Reads the messages of all roles, of images only headers. Throws InputError for a broken message.
BagContents read_contents(const Bag& bag, const TopicRoles& roles);

}  // namespace gpo
