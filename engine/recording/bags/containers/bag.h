// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gpo {

/// How the bytes of a message are to be read: as ROS 1 writes them, or as ROS 2 does.
enum class MessageEncoding { ros1, cdr, unknown };

struct BagTopic {
  std::string name;  ///< "/cam0/image_raw"
  std::string type;  ///< "sensor_msgs/Image", of ROS 2 too
  MessageEncoding encoding = MessageEncoding::unknown;
  std::int64_t messages = 0;
};

/// Where one message lies.
struct BagMessage {
  int topic = 0;                 ///< of `Bag::topics`
  std::int64_t recorded_ns = 0;  ///< when it was written, by the recorder's clock
  std::uint32_t chunk = 0;       ///< what these two mean is the container's secret
  std::uint64_t place = 0;
};

/// The index of a bag, whichever container it is. Nothing but it is in memory.
struct Bag {
  std::filesystem::path file;
  std::vector<BagTopic> topics;      ///< by name
  std::vector<BagMessage> messages;  ///< as they lie in the file, so that going along is fast
  std::vector<std::string> notes;    ///< "cut at byte 1000: ..."
  /// The bytes of a message, or the first `most_bytes` of them. From several threads at once.
  /// Throws InputError where they are broken.
  std::function<std::string(const BagMessage& message, std::uint64_t most_bytes)> read;
};

inline constexpr std::uint64_t kWholeMessage = UINT64_MAX;

/// Of a picture of 64 million pixels, and then some.
inline constexpr std::uint64_t kMostMessageBytes = std::uint64_t{256} << 20;

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

class FileBytes;

/// Opens a bag of any container, told apart by its first bytes. Throws InputError.
Bag open_bag(const std::filesystem::path& file);

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// The index of a ROS 1 bag or of an MCAP file: its own, or, where there is none or it is of no
/// use, what going through the whole file finds, up to where it is cut or broken. Throws
/// InputError.
Bag open_ros1_bag(const std::shared_ptr<const FileBytes>& file);
Bag open_mcap(const std::shared_ptr<const FileBytes>& file);

/// The index of a ROS 2 bag in a database, `topics` and `messages`; where the file is cut, of what
/// can be read of it. Throws InputError.
Bag open_sqlite_bag(const std::filesystem::path& file);

/// The kinds of records in an MCAP file.
enum class McapOp : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  data_end = 15
};

inline constexpr std::uint64_t kMcapRecordHead = 9;  ///< the kind, the length of the content

/// The kinds of records in a ROS 1 bag.
enum class Ros1Op : std::uint8_t {
  message = 2,
  bag_header = 3,
  index = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

}  // namespace gpo
