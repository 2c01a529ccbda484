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

/// What a bag's topics are read as.
enum class TopicRole { image, camera_info, imu, truth };
inline constexpr int kTopicRoles = 4;
template <>
struct ChoiceKeys<TopicRole> {
  static constexpr const char* name = "topic";
  static constexpr std::array<const char*, kTopicRoles> keys = {
      "image", "camera_info", "imu", "truth"};
};

/// The topics that a user chose, by name.
using TopicChoices = std::map<TopicRole, std::string>;

/// "image=/cam0/image_raw", as often as there are roles. Throws SettingError.
TopicChoices parse_topic_choices(const std::vector<std::string>& texts);

struct TopicRoles {
  std::array<std::optional<int>, kTopicRoles> topics;  ///< of `Bag::topics`
  std::vector<std::string> notes;                      ///< "several topics with ..."

  std::optional<int> of(TopicRole role) const { return topics[static_cast<std::size_t>(role)]; }
};

/// Finds a topic with messages for each role by its type: the chosen one, else the one whose name
/// begins most like the pictures', of those the first by name; one that its name calls depth or
/// accelerations only where there is no other. Throws InputError where there are no pictures, or no
/// such topic as was chosen.
TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices);

/// "/imu (sensor_msgs/Imu, 200)", with commas between and only the first of very many.
std::string topics_text(const Bag& bag);

/// What a recording is made of, as the bag has it: by the time stamps in the messages' headers,
/// strictly ascending. Where a header has none it is the time at which it was recorded.
struct BagContents {
  std::vector<std::int64_t> image_times_ns;
  std::vector<BagMessage> images;  ///< as many
  std::string camera_frame;          ///< where the first picture was taken: its `frame_id`
  std::optional<CameraInfoMessage> camera_info;  ///< the first
  std::vector<ImuMessage> imu;
  std::vector<PoseMessage> truth;
  std::vector<PoseMessage> transforms;  ///< of /tf_static
  std::vector<std::string> notes;       ///< what was left out
};

/// Goes through the messages of the topics that have a role, in the order of the file; of pictures
/// it reads the first bytes. Throws InputError where a message is cut or not of its type.
BagContents read_contents(const Bag& bag, const TopicRoles& roles);

}  // namespace gpo
