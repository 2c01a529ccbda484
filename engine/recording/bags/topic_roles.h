// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/recording/bags/containers/bag.h"
#include "engine/recording/bags/messages.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Roles of a bag's topics.
enum class TopicRole { image, camera_info, imu, truth };
inline constexpr int kTopicRoles = 4;
template <>
struct ChoiceKeys<TopicRole> {
  static constexpr const char* name = "topic";
  static constexpr std::array<const char*, kTopicRoles> keys = {
      "image", "camera_info", "imu", "truth"};
};

/// Names of the topics that the user chose.
using TopicChoices = std::map<TopicRole, std::string>;

/// Parses "image=/cam0/image_raw", one text for each role. Throws SettingError.
TopicChoices parse_topic_choices(const std::vector<std::string>& texts);

struct TopicRoles {
  std::array<std::optional<int>, kTopicRoles> topics;  ///< indices in `Bag::topics`
  std::vector<std::string> notes;                      ///< "several topics with ..."

  std::optional<int> of(TopicRole role) const { return topics[static_cast<std::size_t>(role)]; }
};

/// Finds a topic with messages of the right type for each role: the chosen one, otherwise the one
/// with the longest common prefix with the images' topic, otherwise the first by name. Topics with
/// `depth` or `accel` in their names come last. Throws InputError if there are no images or a
/// chosen topic is missing.
TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices);

/// "/imu (sensor_msgs/Imu, 200), ...", abbreviated if there are many.
std::string topics_text(const Bag& bag);

/// A recording's data in a bag, sorted by the time stamps of the messages' headers, strictly
/// ascending. Messages without a time stamp have the time of recording.
struct BagContents {
  std::vector<std::int64_t> image_times_ns;
  std::vector<BagMessage> images;              ///< one for each time
  std::string camera_frame;                      ///< `frame_id` of the first image
  std::optional<CameraInfoMessage> camera_info;  ///< the first
  std::vector<ImuMessage> imu;
  std::vector<PoseMessage> truth;
  std::vector<PoseMessage> transforms;  ///< from /tf_static
  std::vector<std::string> notes;       ///< about ignored messages
};

/// Reads the messages of all topics with a role, of images only the headers. Throws InputError if a
/// message is truncated or not of its type.
BagContents read_contents(const Bag& bag, const TopicRoles& roles);

}  // namespace gpo
