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

/// What is written: a name and a type that `message_type` knows.
struct WrittenTopic {
  std::string name;
  std::string type;
};

/// A bag while it is written: a message after the other, in the order of their times, then the end.
struct BagWriter {
  MessageEncoding encoding;  ///< that the messages are to have
  std::function<void(int topic, std::int64_t time_ns, const std::string& bytes)> write;
  /// Throws InputError where not all of it could be written.
  std::function<void()> finish;
};

/// ROS 1, chunks of 768 KiB, not compressed.
BagWriter ros1_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics);

/// ROS 2 in MCAP, chunks of 4 MiB, compressed by zstd.
BagWriter mcap_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics);

// Messages as bytes, encoded either way: what messages.h reads.

std::string image_bytes(const ImageMessage& message, MessageEncoding encoding);
/// The rectified camera is the same one without distortion.
std::string camera_info_bytes(const CameraInfoMessage& message, MessageEncoding encoding);
/// Says that there is no orientation, and nothing of covariances.
std::string imu_bytes(const ImuMessage& message, MessageEncoding encoding);
/// geometry_msgs/TransformStamped
std::string transform_bytes(const PoseMessage& message, MessageEncoding encoding);
/// tf2_msgs/TFMessage
std::string transforms_bytes(const std::vector<PoseMessage>& messages, MessageEncoding encoding);

/// What a bag says of a type, so that others can read it without knowing it.
struct MessageType {
  const char* name;        ///< "sensor_msgs/Image"
  const char* ros1_sum;    ///< MD5 of the definition
  std::string definition;  ///< its fields, and those of the types that it has
};

/// Of the types above. Throws std::out_of_range for another.
MessageType message_type(const std::string& name, MessageEncoding encoding);

}  // namespace gpo
