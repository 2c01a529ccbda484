// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/messages.h"
#include "engine/recording/refuse.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

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
     {[](const std::string& type) { return type == kImuType; },
      "a gyroscope",
      "sensor_msgs/Imu",
      "accel"},
     {is_pose_type,
      "poses",
      "geometry_msgs/PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
      "nav_msgs/Odometry",
      "covariance"}}};

bool fits(const BagTopic& topic, const RoleKind& kind) {
  return topic.messages > 0 && topic.encoding != MessageEncoding::unknown && kind.fits(topic.type);
}

int chosen(const Bag& bag, const RoleKind& kind, const std::string& name) {
  for (std::size_t i = 0; i < bag.topics.size(); ++i)
    if (bag.topics[i].name == name && fits(bag.topics[i], kind)) return static_cast<int>(i);
  const auto same_name = std::ranges::find(bag.topics, name, &BagTopic::name);
  const std::string found =
      same_name == bag.topics.end()
          ? fmt::format("no topic {} among {}", name, topics_text(bag))
          : fmt::format("{} messages of {} in {}", same_name->messages, same_name->type, name);
  refuse(bag.file, "--topic: found {}, expected {}", found, kind.expected);
}

std::size_t common_beginning(const std::string& a, const std::string& b) {
  return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

/// Returns the topic whose name has the longest common prefix with `like`, or the first by name.
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
  notes.push_back(fmt::format("{} topics with {}: using {}; choose another by --topic {}={}",
                              all.size(),
                              kind.things,
                              bag.topics[best].name,
                              to_string(role),
                              bag.topics[other].name));
  return best;
}

/// Enough for a header, and for a whole Imu or pose with frame names of plausible length.
constexpr std::uint64_t kMostSmallBytes = 2048;
constexpr std::size_t kMostTransforms = 100'000;

struct Image {
  MessageHeader header;
  BagMessage message;
};

struct Reading {
  const Bag& bag;
  BagContents contents{};
  std::vector<Image> images{};
  bool some_without_stamp = false;
};

[[noreturn]] void refuse_message(const Bag& bag, const BagMessage& message) {
  const BagTopic& topic = bag.topics[message.topic];
  const auto number = std::count_if(bag.messages.data(), &message, [&](const BagMessage& other) {
    return other.topic == message.topic;
  });
  refuse(bag.file,
         "{}: message {} is truncated or broken, expected {}",
         topic.name,
         number,
         topic.type);
}

std::string first_bytes(const Reading& reading, const BagMessage& message) {
  return reading.bag.read(message, kMostSmallBytes);
}

template <class T>
T required(const Reading& reading, const BagMessage& message, std::optional<T> made) {
  if (!made) refuse_message(reading.bag, message);
  return *std::move(made);
}

/// The same for a message that begins with a header.
template <class T>
T stamped(Reading& reading, const BagMessage& message, std::optional<T> read) {
  T made = required(reading, message, std::move(read));
  if (made.header.stamp_ns != 0) return made;
  made.header.stamp_ns = message.recorded_ns;
  reading.some_without_stamp |= message.recorded_ns != 0;
  return made;
}

void read_image_of(Reading& reading, const BagMessage& message, const BagTopic& topic) {
  const auto header = read_header(first_bytes(reading, message), topic.encoding);
  reading.images.push_back(
      stamped(reading, message, header ? std::optional(Image{*header, message}) : std::nullopt));
}

void read_camera_info_of(Reading& reading, const BagMessage& message, const BagTopic& topic) {
  auto& first = reading.contents.camera_info;
  if (first) return;
  first =
      required(reading, message, read_camera_info(first_bytes(reading, message), topic.encoding));
}

void read_imu_of(Reading& reading, const BagMessage& message, const BagTopic& topic) {
  reading.contents.imu.push_back(
      stamped(reading, message, read_imu(first_bytes(reading, message), topic.encoding)));
}

void read_truth_of(Reading& reading, const BagMessage& message, const BagTopic& topic) {
  auto& truth = reading.contents.truth;
  PoseMessage pose = stamped(
      reading, message, read_pose(first_bytes(reading, message), topic.encoding, topic.type));
  if (truth.empty() || truth.front().child_frame_id == pose.child_frame_id)
    truth.push_back(std::move(pose));
}

void read_transforms_of(Reading& reading, const BagMessage& message, const BagTopic& topic) {
  auto& all = reading.contents.transforms;
  if (all.size() > kMostTransforms) return;
  const std::string bytes = reading.bag.read(message, kWholeMessage);
  const auto some = required(reading, message, read_transforms(bytes, topic.encoding));
  all.insert(all.end(), some.begin(), some.end());
}

using Reader = void (*)(Reading& reading, const BagMessage& message, const BagTopic& topic);

constexpr std::array<Reader, kTopicRoles> kReaders = {
    read_image_of, read_camera_info_of, read_imu_of, read_truth_of};

bool is_static_transforms(const BagTopic& topic) {
  return topic.type == kTransformsType && topic.name.ends_with("tf_static") &&
         topic.encoding != MessageEncoding::unknown;
}

/// Sorts by time and drops messages with repeated time stamps, with a note.
template <class T>
void put_in_order(std::vector<T>& all, const char* things, std::vector<std::string>& notes) {
  const auto time = [](const T& one) { return one.header.stamp_ns; };
  std::ranges::stable_sort(all, {}, time);
  const auto same_time = [&](const T& a, const T& b) { return time(a) == time(b); };
  const auto again = std::unique(all.begin(), all.end(), same_time);  // clang 14 cannot do ranges'
  if (again == all.end()) return;
  notes.push_back(
      fmt::format("ignoring {} {} with repeated time stamps", all.end() - again, things));
  all.erase(again, all.end());
}

}  // namespace

TopicChoices parse_topic_choices(const std::vector<std::string>& texts) {
  TopicChoices choices;
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
      throw SettingError(
          "topic", fmt::format("found '{}', expected ROLE=NAME, e.g. image=/cam0/image_raw", text));
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
    if (!topic)
      refuse(bag.file,
             "found no images among {}, expected a topic of type {}",
             topics_text(bag),
             kRoles[i].expected);
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

BagContents read_contents(const Bag& bag, const TopicRoles& roles) {
  std::vector<Reader> readers(bag.topics.size(), nullptr);
  for (std::size_t i = 0; i < readers.size(); ++i)
    if (is_static_transforms(bag.topics[i])) readers[i] = read_transforms_of;
  for (int i = 0; i < kTopicRoles; ++i)
    if (const auto topic = roles.topics[i]) readers[*topic] = kReaders[i];
  Reading reading{bag};
  for (const BagMessage& message : bag.messages)
    if (const Reader read = readers[message.topic])
      read(reading, message, bag.topics[message.topic]);

  BagContents& contents = reading.contents;
  put_in_order(reading.images, "images", contents.notes);
  put_in_order(contents.imu, "gyroscope samples", contents.notes);
  put_in_order(contents.truth, "poses", contents.notes);
  for (const Image& image : reading.images) {
    contents.image_times_ns.push_back(image.header.stamp_ns);
    contents.images.push_back(image.message);
  }
  contents.camera_frame = reading.images.front().header.frame_id;
  if (reading.some_without_stamp)
    contents.notes.emplace_back("using the times of recording for messages without time stamps");
  return std::move(reading.contents);
}

}  // namespace gpo
