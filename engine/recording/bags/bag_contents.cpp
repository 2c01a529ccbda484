// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/bag_contents.h"

#include "engine/base/error.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Enough for a header, and for all of an Imu or a pose, if frames have names that people can read.
constexpr std::uint64_t kMostSmallBytes = 2048;
constexpr std::size_t kMostTransforms = 100'000;

struct Picture {
  MessageHeader header;
  BagMessage message;
};

/// While the messages are gone through.
struct Reading {
  const Bag& bag;
  BagContents contents{};
  std::vector<Picture> pictures{};
  bool some_without_stamp = false;
};

[[noreturn]] void refuse(const Bag& bag, const BagMessage& message) {
  const BagTopic& topic = bag.topics[message.topic];
  const auto number = std::count_if(bag.messages.data(), &message, [&](const BagMessage& other) {
    return other.topic == message.topic;
  });
  throw InputError(fmt::format("{}: {}: message {} is cut or none, expected {}",
                               bag.file.string(),
                               topic.name,
                               number,
                               topic.type));
}

/// What `read` makes of a message's first bytes.
template <class Read>
auto read_one(Reading& reading, const BagMessage& message, std::uint64_t most_bytes, Read read) {
  const BagTopic& topic = reading.bag.topics[message.topic];
  auto made = read(reading.bag.read(message, most_bytes), topic);
  if (!made) refuse(reading.bag, message);
  return *std::move(made);
}

/// The same of a message that begins with a header.
template <class Read>
auto read_stamped(Reading& reading, const BagMessage& message, Read read) {
  auto made = read_one(reading, message, kMostSmallBytes, read);
  if (made.header.stamp_ns != 0) return made;
  made.header.stamp_ns = message.recorded_ns;
  reading.some_without_stamp |= message.recorded_ns != 0;
  return made;
}

void read_picture_of(Reading& reading, const BagMessage& message) {
  reading.pictures.push_back(
      read_stamped(reading, message, [&](const std::string& bytes, const BagTopic& topic) {
        const auto header = read_header(bytes, topic.encoding);
        return header ? std::optional(Picture{*header, message}) : std::nullopt;
      }));
}

void read_camera_info_of(Reading& reading, const BagMessage& message) {
  auto& first = reading.contents.camera_info;
  if (first) return;
  first = read_one(
      reading, message, kMostSmallBytes, [](const std::string& bytes, const BagTopic& topic) {
        return read_camera_info(bytes, topic.encoding);
      });
}

void read_imu_of(Reading& reading, const BagMessage& message) {
  reading.contents.imu.push_back(
      read_stamped(reading, message, [](const std::string& bytes, const BagTopic& topic) {
        return read_imu(bytes, topic.encoding);
      }));
}

/// Of a topic that tells of several things the first one.
void read_truth_of(Reading& reading, const BagMessage& message) {
  auto& truth = reading.contents.truth;
  PoseMessage pose =
      read_stamped(reading, message, [](const std::string& bytes, const BagTopic& topic) {
        return read_pose(bytes, topic.encoding, topic.type);
      });
  if (truth.empty() || truth.front().child_frame_id == pose.child_frame_id)
    truth.push_back(std::move(pose));
}

void read_transforms_of(Reading& reading, const BagMessage& message) {
  auto& all = reading.contents.transforms;
  if (all.size() > kMostTransforms) return;
  const auto some = read_one(
      reading, message, kWholeMessage, [](const std::string& bytes, const BagTopic& topic) {
        return read_transforms(bytes, topic.encoding);
      });
  all.insert(all.end(), some.begin(), some.end());
}

/// As `TopicRole` counts them.
constexpr std::array<void (*)(Reading&, const BagMessage&), kTopicRoles> kReaders = {
    read_picture_of, read_camera_info_of, read_imu_of, read_truth_of};

bool is_static_transforms(const BagTopic& topic) {
  return topic.type == kTransformsType && topic.name.ends_with("tf_static") &&
         topic.encoding != MessageEncoding::unknown;
}

/// Strictly ascending in time; says how many had a time that was there already.
template <class T>
void put_in_order(std::vector<T>& all, const char* things, std::vector<std::string>& notes) {
  const auto time = [](const T& one) { return one.header.stamp_ns; };
  std::ranges::stable_sort(all, {}, time);
  const auto same_time = [&](const T& a, const T& b) { return time(a) == time(b); };
  const auto again = std::unique(all.begin(), all.end(), same_time);  // clang 14 cannot do ranges'
  if (again == all.end()) return;
  notes.push_back(fmt::format(
      "{} {} are left out: they have the time stamps of others", all.end() - again, things));
  all.erase(again, all.end());
}

}  // namespace

BagContents read_contents(const Bag& bag, const TopicRoles& roles) {
  std::vector<void (*)(Reading&, const BagMessage&)> readers(bag.topics.size(), nullptr);
  for (std::size_t i = 0; i < readers.size(); ++i)
    if (is_static_transforms(bag.topics[i])) readers[i] = read_transforms_of;
  for (int i = 0; i < kTopicRoles; ++i)
    if (const auto topic = roles.topics[i]) readers[*topic] = kReaders[i];
  Reading reading{bag};
  for (const BagMessage& message : bag.messages)
    if (readers[message.topic] != nullptr) readers[message.topic](reading, message);

  BagContents& contents = reading.contents;
  put_in_order(reading.pictures, "pictures", contents.notes);
  put_in_order(contents.imu, "samples of the gyroscope", contents.notes);
  put_in_order(contents.truth, "poses", contents.notes);
  for (const Picture& picture : reading.pictures) {
    contents.picture_times_ns.push_back(picture.header.stamp_ns);
    contents.pictures.push_back(picture.message);
  }
  contents.camera_frame = reading.pictures.front().header.frame_id;
  if (reading.some_without_stamp)
    contents.notes.emplace_back(
        "messages without a time stamp have the time at which they were recorded");
  return std::move(reading.contents);
}

}  // namespace gpo
