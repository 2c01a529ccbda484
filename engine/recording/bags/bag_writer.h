// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"
#include "engine/recording/bags/messages.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace gpo {

/// A topic's name and its type, which `message_type` must know.
struct WrittenTopic {
  std::string name;
  std::string type;
};

/// Writes a bag: messages in the order of time, then the end.
struct BagWriter {
  MessageEncoding encoding;  ///< required for the messages
  std::function<void(int topic, std::int64_t time_ns, const std::string& bytes)> write;
  /// Throws InputError if the file is incomplete.
  std::function<void()> finish;
};

/// ROS 1, uncompressed chunks of 768 KiB.
BagWriter ros1_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics);

/// ROS 2 in MCAP, chunks of 4 MiB compressed with zstd.
BagWriter mcap_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics);

// Encoders of messages, the inverse of the readers in messages.h.

std::string image_bytes(const ImageMessage& message, MessageEncoding encoding);
/// The rectified camera has the same matrix without distortion.
std::string camera_info_bytes(const CameraInfoMessage& message, MessageEncoding encoding);
/// Marks orientation and covariances as unknown.
std::string imu_bytes(const ImuMessage& message, MessageEncoding encoding);
/// geometry_msgs/TransformStamped
std::string transform_bytes(const PoseMessage& message, MessageEncoding encoding);
/// tf2_msgs/TFMessage
std::string transforms_bytes(const std::vector<PoseMessage>& messages, MessageEncoding encoding);

/// Description of a type that a bag contains for its readers.
struct MessageType {
  const char* name;        ///< "sensor_msgs/Image"
  const char* ros1_sum;    ///< MD5 of the definition
  std::string definition;  ///< its fields, and those of the types of its fields
};

/// Knows the types above. Throws std::out_of_range for others.
MessageType message_type(const std::string& name, MessageEncoding encoding);

}  // namespace gpo
