// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/bag.h"

#include "engine/recording/refuse.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

namespace gpo {
void TopicList::add(std::int64_t id,
                    std::string_view name,
                    std::string_view type,
                    MessageEncoding encoding) {
  if (knows(id)) return;
  constexpr std::string_view kOfRos2 = "/msg/";
  const auto at = type.find(kOfRos2);
  const std::string of_ros_1 =
      at == std::string_view::npos
          ? std::string(type)
          : fmt::format("{}/{}", type.substr(0, at), type.substr(at + kOfRos2.size()));
  const auto [found, is_new] =
      by_name_.emplace(std::pair(std::string(name), of_ros_1), static_cast<int>(by_name_.size()));
  if (is_new) bag_.topics.push_back({std::string(name), of_ros_1, encoding});
  by_id_[id] = found->second;
}

void TopicList::add_message(std::int64_t id,
                            std::int64_t recorded_ns,
                            std::uint32_t chunk,
                            std::uint64_t place) {
  const auto found = by_id_.find(id);
  if (found == by_id_.end()) return;
  // Limited so that differences of times do not overflow.
  const std::int64_t time = std::clamp(recorded_ns, std::int64_t{0}, std::int64_t{1} << 61);
  bag_.messages.push_back({found->second, time, chunk, place});
  ++bag_.topics[found->second].messages;
}

void TopicList::drop_last() {
  --bag_.topics[bag_.messages.back().topic].messages;
  bag_.messages.pop_back();
}

void TopicList::clear_messages() {
  bag_.messages.clear();
  for (BagTopic& topic : bag_.topics) topic.messages = 0;
}

void TopicList::finish() {
  std::vector<int> order(bag_.topics.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](int i) { return bag_.topics[i].name; });
  std::vector<int> new_place(order.size());
  std::vector<BagTopic> sorted;
  for (const int old : order) {
    new_place[old] = static_cast<int>(sorted.size());
    sorted.push_back(std::move(bag_.topics[old]));
  }
  bag_.topics = std::move(sorted);
  for (BagMessage& message : bag_.messages) message.topic = new_place[message.topic];
  std::ranges::sort(bag_.messages, {}, [](const BagMessage& message) {
    return std::pair(message.chunk, message.place);
  });
}

Bag BagOpening::finish(std::string (*read_message)(const ChunkReader&,
                                                   const BagMessage&,
                                                   std::uint64_t)) {
  topics.finish();
  bag.read = [chunks = std::shared_ptr<const ChunkReader>(chunks), read_message](
                 const BagMessage& message, std::uint64_t most_bytes) {
    return read_message(*chunks, message, most_bytes);
  };
  return std::move(bag);
}
Bag open_bag(const std::filesystem::path& file) {
  const auto bytes = std::make_shared<const FileBytes>(file);
  const std::string begin = bytes->read(0, 16);
  if (begin.starts_with(kRos1Magic)) return open_ros1_bag(bytes);
  if (begin.starts_with(kMcapMagic)) return open_mcap(bytes);
  if (begin == std::string("SQLite format 3\0", 16)) return open_sqlite_bag(file);
  if (begin.starts_with("#ROSRECORD") || begin.starts_with("#ROSLOG"))
    refuse(file, "found an old bag format, expected version 2.0 (rosbag fix converts)");
  refuse(file, "not a bag, expected ROS 1 (version 2.0), MCAP or a SQLite database");
}

}  // namespace gpo
