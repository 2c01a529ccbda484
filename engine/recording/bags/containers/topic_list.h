// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/containers/bag.h"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace gpo {

/// Makes one topic of all connections that have its name and type, and puts topics in order.
class TopicList {
 public:
  explicit TopicList(Bag& bag) : bag_(bag) {}

  /// What a file calls `id` is this topic; the first word on an id counts. ROS 2's
  /// "sensor_msgs/msg/Image" is "sensor_msgs/Image" to us.
  void add(std::int64_t id, std::string_view name, std::string_view type, MessageEncoding encoding);
  bool knows(std::int64_t id) const { return by_id_.contains(id); }
  /// Nothing where the id is unknown.
  void add_message(std::int64_t id,
                   std::int64_t recorded_ns,
                   std::uint32_t chunk,
                   std::uint64_t place);
  void drop_last();
  /// Forgets the messages.
  void clear_messages();
  /// Sorts the bag's topics by name, its messages as they lie in the file; the last call.
  void finish();

 private:
  Bag& bag_;
  std::map<std::int64_t, int> by_id_;
  std::map<std::pair<std::string, std::string>, int> by_name_;
};

}  // namespace gpo
