// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/recording/bags/messages.h"

#include <algorithm>

#include <fmt/ranges.h>

namespace gpo {
namespace {

bool is_imu_type(const std::string& type) { return type == kImuType; }

struct RoleKind {
  bool (*fits)(const std::string& type);
  const char* things;    ///< "several topics with THINGS"
  const char* expected;  ///< the types
  const char* unlikely;  ///< word in the names of topics with other data
};

constexpr std::array<RoleKind, kTopicRoles> kRoles = {
    {{is_image_type, "images", "sensor_msgs/Image or CompressedImage", "depth"},
     {[](const std::string& type) { return type == kCameraInfoType; },
      "calibrations",
      "sensor_msgs/CameraInfo",
      "depth"},
     {is_imu_type, "a gyroscope", kImuType, "accel"},
     {is_pose_type,
      "poses",
      "geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
      "nav_msgs/Odometry",
      "covariance"},
     {is_imu_type, "a gyroscope", kImuType, "accel"},
     {is_imu_type, "an accelerometer", kImuType, "gyro"}}};

bool fits(const BagTopic& topic, const RoleKind& kind) {
  return topic.messages > 0 && topic.encoding != MessageEncoding::unknown && kind.fits(topic.type);
}

/// Returns the notes of a bag, such as that it is truncated, for the end of a message.
std::string notes_text(const Bag& bag) {
  return bag.notes.empty() ? "" : fmt::format("; {}", fmt::join(bag.notes, "; "));
}

int chosen(const Bag& bag, const RoleKind& kind, const std::string& name) {
  for (std::size_t i = 0; i < bag.topics.size(); ++i)
    if (bag.topics[i].name == name && fits(bag.topics[i], kind)) return static_cast<int>(i);
  const auto same_name = std::ranges::find(bag.topics, name, &BagTopic::name);
  const std::string found =
      same_name == bag.topics.end()
          ? fmt::format("no topic {} among {}", name, topics_text(bag))
          : fmt::format("{} messages of {} in {}", same_name->messages, same_name->type, name);
  refuse(bag.file, "--topic: found {}, expected {}{}", found, kind.expected, notes_text(bag));
}

std::vector<int> fitting(const Bag& bag, const RoleKind& kind) {
  std::vector<int> all;
  for (std::size_t i = 0; i < bag.topics.size(); ++i)
    if (fits(bag.topics[i], kind)) all.push_back(static_cast<int>(i));
  return all;
}

/// Returns the first message that `read` can read; nullopt if there is none.
template <class Read>
auto first_of(const Bag& bag, int topic, Read read)
    -> decltype(read(std::string_view(), MessageEncoding::cdr)) {
  const auto message = std::ranges::find(bag.messages, topic, &BagMessage::topic);
  if (message == bag.messages.end()) return std::nullopt;
  return read(bag.read(*message, kMostSmallBytes), bag.topics[topic].encoding);
}

/// Builds the roles; `like` is the images' topic.
struct Assignment {
  const Bag& bag;
  const TopicChoices& choices;
  TopicRoles roles{};
  std::string like{};

  std::optional<int> chosen_topic(TopicRole role) const {
    const auto choice = choices.find(role);
    if (choice == choices.end()) return std::nullopt;
    return chosen(bag, kRoles[static_cast<std::size_t>(role)], choice->second);
  }
  void set(TopicRole role, std::optional<int> topic) {
    roles.topics[static_cast<std::size_t>(role)] = topic;
  }

  /// Returns the best of some topics, with a note if there are several.
  std::optional<int> best(const std::vector<int>& all, TopicRole role, bool with_note = true) {
    if (all.empty()) return std::nullopt;
    const RoleKind& kind = kRoles[static_cast<std::size_t>(role)];
    const int best = *std::ranges::max_element(all, {}, [&](int i) {
      const std::string& name = bag.topics[i].name;
      const auto common = std::ranges::mismatch(name, like).in1 - name.begin();
      return std::pair(name.find(kind.unlikely) == std::string::npos, common);
    });
    if (all.size() == 1 || !with_note) return best;
    const int other = all.front() == best ? all[1] : all.front();
    roles.notes.push_back(
        fmt::format("{} topics with {}: using {}; choose another with --topic {}={}",
                    all.size(),
                    kind.things,
                    bag.topics[best].name,
                    to_string(role),
                    bag.topics[other].name));
    return best;
  }

  void add(TopicRole role) {
    const auto topic = chosen_topic(role);
    set(role, topic ? topic : best(fitting(bag, kRoles[static_cast<std::size_t>(role)]), role));
  }

  void add_calibration() {
    const auto topic = chosen_topic(TopicRole::camera_info);
    std::vector<int> all = topic ? std::vector{*topic} : fitting(bag, kRoles[1]);
    const std::vector<int> found = all;
    std::erase_if(all, [&](int i) {
      const auto info = first_of(bag, i, read_camera_info);
      return info && !is_calibrated(*info);
    });
    set(TopicRole::camera_info, best(all, TopicRole::camera_info, false));
    if (all.empty() && !found.empty())
      roles.notes.push_back(bag.topics[*best(found, TopicRole::camera_info, false)].name +
                            ": not used, its matrices K and P are zero");
  }

  void add_imu();
};

/// Sensors whose values vary from zero in a topic's first messages.
struct Sensors {
  bool rates = false;
  bool accelerations = false;
};

Sensors sensors_of(const Bag& bag, int topic) {
  constexpr int kProbed = 100;
  const auto measures = [](const std::optional<Eigen::Vector3d>& value) {
    return value && !value->isZero(0);
  };
  Sensors found;
  int probed = 0;
  for (const BagMessage& message : bag.messages) {
    if (message.topic != topic) continue;
    if (probed++ == kProbed) break;
    const auto imu = read_imu(bag.read(message, kMostSmallBytes), bag.topics[topic].encoding);
    found.rates = found.rates || (imu && measures(imu->angular_velocity));
    found.accelerations = found.accelerations || (imu && measures(imu->linear_acceleration));
  }
  return found;
}

void Assignment::add_imu() {
  const auto imu = chosen_topic(TopicRole::imu);
  auto gyroscope = chosen_topic(TopicRole::gyroscope);
  auto accelerometer = chosen_topic(TopicRole::accelerometer);
  const std::vector<int> all = fitting(bag, kRoles[static_cast<std::size_t>(TopicRole::imu)]);
  const bool apart = gyroscope || accelerometer;
  if (!apart && (imu || all.size() < 2))
    return set(TopicRole::imu, imu ? imu : best(all, TopicRole::imu));
  std::vector<int> both, rates, accelerations;
  for (const int i : all) {
    const Sensors sensors = sensors_of(bag, i);
    if (sensors.rates) (sensors.accelerations ? both : rates).push_back(i);
    if (sensors.accelerations && !sensors.rates) accelerations.push_back(i);
  }
  if (!apart && (!both.empty() || rates.empty() || accelerations.empty()))
    return set(TopicRole::imu, best(both.empty() ? all : both, TopicRole::imu));
  if (!gyroscope) gyroscope = imu ? imu : best(both.empty() ? rates : both, TopicRole::gyroscope);
  if (gyroscope) like = bag.topics[*gyroscope].name;
  const bool has_both = gyroscope && std::ranges::find(both, *gyroscope) != both.end();
  if (!accelerometer)
    accelerometer = has_both ? gyroscope : best(accelerations, TopicRole::accelerometer);
  if (gyroscope == accelerometer || !gyroscope) return set(TopicRole::imu, accelerometer);
  set(TopicRole::gyroscope, gyroscope);
  set(TopicRole::accelerometer, accelerometer);
}

}  // namespace

TopicChoices parse_topic_choices(const std::vector<std::string>& texts) {
  TopicChoices choices;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      refuse_setting("topic", "found '{}', expected ROLE=NAME, e.g. image=/cam0/image_raw", text);
    const std::string name = text.substr(0, equals);
    const auto role = name == "pose" ? TopicRole::truth : choice<TopicRole>(name);
    if (!choices.emplace(role, text.substr(equals + 1)).second)
      refuse_setting("topic", "found {} twice", to_string(role));
  }
  return choices;
}

TopicRoles topic_roles(const Bag& bag, const TopicChoices& choices) {
  Assignment made{bag, choices};
  made.add(TopicRole::image);
  const auto images = made.roles.of(TopicRole::image);
  if (!images)
    refuse(bag.file,
           "found no images among {}, expected a topic of type {}{}",
           topics_text(bag),
           kRoles[0].expected,
           notes_text(bag));
  made.like = bag.topics[*images].name;
  made.add_calibration();
  made.add(TopicRole::truth);
  made.add_imu();
  return std::move(made.roles);
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
                                legible(topic.shown_type(), kLongest),
                                topic.messages));
  }
  if (bag.topics.size() > kShown)
    texts.push_back(fmt::format("{} more", bag.topics.size() - kShown));
  return fmt::format("{}", fmt::join(texts, ", "));
}

}  // namespace gpo
