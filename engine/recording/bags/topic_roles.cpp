// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/topic_roles.h"

#include "engine/base/error.h"
#include "engine/recording/bags/messages.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Topics that have a role, for people.
struct RoleKind {
  bool (*fits)(const std::string& type);
  const char* things;    ///< "several topics with THINGS"
  const char* expected;  ///< the types
  const char* unlikely;  ///< word in the names of topics of these types that are something else
};

bool is_camera_info(const std::string& type) { return type == kCameraInfoType; }
bool is_imu(const std::string& type) { return type == kImuType; }

/// As `TopicRole` counts them.
constexpr std::array<RoleKind, kTopicRoles> kRoles = {
    {{is_picture_type, "pictures", "sensor_msgs/Image or CompressedImage", "depth"},
     {is_camera_info, "calibrations", "sensor_msgs/CameraInfo", "depth"},
     {is_imu, "a gyroscope", "sensor_msgs/Imu", "accel"},
     {is_pose_type,
      "poses",
      "geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
      "nav_msgs/Odometry",
      "covariance"}}};

bool fits(const BagTopic& topic, const RoleKind& kind) {
  return topic.messages > 0 && topic.encoding != MessageEncoding::unknown && kind.fits(topic.type);
}

std::string file_of(const Bag& bag) { return bag.file.string(); }

int chosen(const Bag& bag, const RoleKind& kind, const std::string& name) {
  for (std::size_t i = 0; i < bag.topics.size(); ++i) {
    if (bag.topics[i].name == name && fits(bag.topics[i], kind)) return static_cast<int>(i);
  }
  const auto same_name = std::ranges::find(bag.topics, name, &BagTopic::name);
  const std::string found =
      same_name == bag.topics.end()
          ? fmt::format("no topic {} among {}", name, topics_text(bag))
          : fmt::format("{} messages of {} in {}", same_name->messages, same_name->type, name);
  throw InputError(
      fmt::format("{}: --topic: found {}, expected {}", file_of(bag), found, kind.expected));
}

std::size_t common_beginning(const std::string& a, const std::string& b) {
  return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

/// The first by name, or the one whose name begins most like `like`.
std::optional<int> found(const Bag& bag,
                         TopicRole role,
                         const std::string& like,
                         std::vector<std::string>& notes) {
  const RoleKind& kind = kRoles[static_cast<std::size_t>(role)];
  std::vector<int> all;
  for (std::size_t i = 0; i < bag.topics.size(); ++i)
    if (fits(bag.topics[i], kind)) all.push_back(static_cast<int>(i));
  if (all.empty()) return std::nullopt;
  const int best = *std::ranges::max_element(all, {}, [&](int i) {
    const std::string& name = bag.topics[i].name;
    return std::pair(name.find(kind.unlikely) == std::string::npos, common_beginning(name, like));
  });
  if (all.size() == 1 || role == TopicRole::camera_info) return best;
  const int other = all.front() == best ? all[1] : all.front();
  notes.push_back(fmt::format("{} topics with {}: {} is read; --topic {}={} reads another",
                              all.size(),
                              kind.things,
                              bag.topics[best].name,
                              to_string(role),
                              bag.topics[other].name));
  return best;
}

}  // namespace

TopicChoices parse_topic_choices(const std::vector<std::string>& texts) {
  TopicChoices choices;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size()) {
      throw SettingError(
          "topic", fmt::format("found '{}', expected ROLE=NAME, e.g. image=/cam0/image_raw", text));
    }
    const auto role = choice<TopicRole>(text.substr(0, equals));
    if (!choices.emplace(role, text.substr(equals + 1)).second)
      throw SettingError("topic", fmt::format("found {} twice", to_string(role)));
  }
  return choices;
}

TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices) {
  TopicRoles roles;
  std::string like;
  for (int i = 0; i < kTopicRoles; ++i) {
    const auto role = static_cast<TopicRole>(i);
    const auto choice = choices.find(role);
    auto& topic = roles.topics[i];
    topic = choice == choices.end() ? found(bag, role, like, roles.notes)
                                    : std::optional(chosen(bag, kRoles[i], choice->second));
    if (role != TopicRole::image) continue;
    if (!topic) {
      throw InputError(fmt::format("{}: found no camera among {}, expected a topic of {}",
                                   file_of(bag),
                                   topics_text(bag),
                                   kRoles[i].expected));
    }
    like = bag.topics[*topic].name;
  }
  return roles;
}

std::string topics_text(const Bag& bag) {
  constexpr std::size_t kShown = 10;
  constexpr std::size_t kLongest = 60;
  if (bag.topics.empty()) return "no topics";
  std::vector<std::string> texts;
  for (const BagTopic& topic : bag.topics) {
    if (texts.size() == kShown) break;
    texts.push_back(fmt::format("{} ({}, {})",
                                legible(topic.name, kLongest),
                                legible(topic.type, kLongest),
                                topic.messages));
  }
  if (bag.topics.size() > kShown)
    texts.push_back(fmt::format("{} more", bag.topics.size() - kShown));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace gpo
