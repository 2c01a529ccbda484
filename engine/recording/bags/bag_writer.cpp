// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/recording/bags/messages.h"

#include <algorithm>
#include <fstream>

#include <zstd.h>

namespace gpo {
namespace {

template <class Length = std::uint32_t>
std::string stored_text(std::string_view text) {
  return stored(static_cast<Length>(text.size())).append(text);
}

class ByteStream {
 public:
  explicit ByteStream(const fs::path& file) : file_(file), stream_(file, std::ios::binary) {}

  std::uint64_t place() const { return place_; }
  void write(std::string_view bytes) {
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    place_ += bytes.size();
  }
  void write_at(std::uint64_t place, std::string_view bytes) {
    stream_.seekp(static_cast<std::streamoff>(place));
    stream_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream_.seekp(static_cast<std::streamoff>(place_));
  }
  void finish() {
    stream_.close();
    if (!stream_) refuse(file_, "cannot be written");
  }

 private:
  fs::path file_;
  std::ofstream stream_;
  std::uint64_t place_ = 0;
};

/// Returns whether players keep a topic's last message for late subscribers, as ROS does with
/// static transforms.
bool is_latched(std::string_view topic) { return topic.ends_with("/tf_static"); }

template <class Writer>
BagWriter bag_writer(MessageEncoding encoding, std::shared_ptr<Writer> writer) {
  return {
      encoding,
      [writer](int topic, auto ns, const std::string& bytes) { writer->write(topic, ns, bytes); },
      [writer] { writer->finish(); }};
}

}  // namespace

namespace ros1 {
namespace {

constexpr std::size_t kChunkBytes = 768 << 10;
constexpr std::uint32_t kHeaderBytes = 4096;  ///< the bag's header including padding

std::string field(std::string_view name, std::string_view value) {
  return stored_text(std::string(name) + "=" + std::string(value));
}

std::string op(Ros1Op op) { return field("op", std::string(1, static_cast<char>(op))); }

std::string record(const std::string& fields, const std::string& data) {
  return stored_text(fields) + stored_text(data);
}

std::string time_bytes(std::int64_t ns) {
  return stored<std::uint32_t>(ns / 1'000'000'000) + stored<std::uint32_t>(ns % 1'000'000'000);
}

struct Entries {
  std::uint32_t count = 0;
  std::string bytes;  ///< time and place of each
};

class Ros1Writer {
 public:
  Ros1Writer(const fs::path& file, const std::vector<BagTopic>& topics)
      : stream_(file), topics_(topics) {
    stream_.write(kRos1Magic);
    stream_.write(header(0));
  }

  void write(int topic, std::int64_t ns, const std::string& bytes) {
    if (chunk_.empty()) first_ns_ = last_ns_ = ns;
    first_ns_ = std::min(first_ns_, ns);
    last_ns_ = std::max(last_ns_, ns);
    if (entries_[topic].count == 0) chunk_ += connection(topic);
    Entries& entries = entries_[topic];
    ++entries.count;
    entries.bytes += time_bytes(ns) + stored<std::uint32_t>(chunk_.size());
    chunk_ += record(op(Ros1Op::message) + field("conn", stored<std::uint32_t>(topic)) +
                         field("time", time_bytes(ns)),
                     bytes);
    if (chunk_.size() >= kChunkBytes) write_chunk();
  }

  void finish() {
    if (!chunk_.empty()) write_chunk();
    const std::uint64_t index = stream_.place();
    for (std::size_t i = 0; i < topics_.size(); ++i) stream_.write(connection(static_cast<int>(i)));
    stream_.write(infos_);
    stream_.write_at(kRos1Magic.size(), header(index));
    stream_.finish();
  }

 private:
  std::string header(std::uint64_t index) const {
    const std::string fields = op(Ros1Op::bag_header) + field("index_pos", stored(index)) +
                               field("conn_count", stored<std::uint32_t>(topics_.size())) +
                               field("chunk_count", stored(chunks_));
    return record(fields, std::string(kHeaderBytes - 8 - fields.size(), ' '));
  }

  std::string connection(int topic) const {
    const std::string &name = topics_[topic].name, &type = topics_[topic].type;
    const MessageType about = message_type(type, MessageEncoding::ros1);
    return record(
        op(Ros1Op::connection) + field("conn", stored<std::uint32_t>(topic)) + field("topic", name),
        field("topic", name) + field("type", type) + field("md5sum", about.ros1_sum) +
            field("message_definition", about.definition) +
            (is_latched(topics_[topic].name) ? field("latching", "1") : ""));
  }

  void write_chunk() {
    const std::uint64_t place = stream_.place();
    stream_.write(record(op(Ros1Op::chunk) + field("compression", "none") +
                             field("size", stored<std::uint32_t>(chunk_.size())),
                         chunk_));
    std::string counts;
    for (const auto& [topic, entries] : entries_) {
      counts += stored<std::uint32_t>(topic) + stored(entries.count);
      stream_.write(record(op(Ros1Op::index) + field("ver", stored<std::uint32_t>(1)) +
                               field("conn", stored<std::uint32_t>(topic)) +
                               field("count", stored(entries.count)),
                           entries.bytes));
    }
    infos_ +=
        record(op(Ros1Op::chunk_info) + field("ver", stored<std::uint32_t>(1)) +
                   field("chunk_pos", stored(place)) + field("start_time", time_bytes(first_ns_)) +
                   field("end_time", time_bytes(last_ns_)) +
                   field("count", stored<std::uint32_t>(entries_.size())),
               counts);
    ++chunks_;
    chunk_.clear();
    entries_.clear();
  }

  ByteStream stream_;
  std::vector<BagTopic> topics_;
  std::string chunk_;
  std::map<int, Entries> entries_;  ///< current chunk
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::string infos_;  ///< records about all chunks
  std::uint32_t chunks_ = 0;
};

}  // namespace
}  // namespace ros1

namespace mcap {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{4} << 20;

std::string record(McapOp op, const std::string& content) {
  std::string bytes(1, static_cast<char>(op));
  bytes += stored_text<std::uint64_t>(content);
  return bytes;
}

constexpr McapOp kMetadata{12}, kMetadataIndex{13};

/// Returns a map of texts; the order of the keys is free.
using TextPairs = std::vector<std::pair<std::string, std::string>>;

std::string stored_map(const TextPairs& map) {
  std::string bytes;
  for (const auto& [key, value] : map) bytes += stored_text(key) + stored_text(value);
  return stored_text(bytes);
}

/// Returns rosbag2's list of the profiles of a topic's publishers, in the numbers of `rmw`. ROS 2
/// gives a topic's last message to late subscribers only if it is "transient local".
std::string offered_qos_profiles(bool latched) {
  const std::string forever = "\n    sec: 9223372036\n    nsec: 854775807\n";
  return std::string("- history: 1\n  depth: 10\n  reliability: 1\n  durability: ") +
         (latched ? "1" : "2") + "\n  deadline:" + forever + "  lifespan:" + forever +
         "  liveliness: 1\n  liveliness_lease_duration:" + forever +
         "  avoid_ros_namespace_conventions: false";
}

/// rosbag2's description of the bag. While it is empty, rosbag2 since Jazzy reads the profiles as
/// numbers, the only form that older ones know; without the record it expects words.
std::string rosbag2_record() {
  const std::string about = stored_map({{"serialized_metadata", ""}, {"ROS_DISTRO", ""}});
  return record(kMetadata, stored_text("rosbag2") + about);
}

std::string compressed(const std::string& bytes) {
  std::string made(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(made.data(), made.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw InputError("zstd: cannot compress");
  made.resize(size);
  return made;
}

std::vector<McapChannel> ros2_channels(const std::vector<BagTopic>& topics) {
  std::vector<McapChannel> channels;
  for (const BagTopic& topic : topics) {
    std::string ros2_name = topic.type;
    ros2_name.insert(ros2_name.find('/'), "/msg");  // "sensor_msgs/msg/Image"
    channels.push_back({.topic = topic.name,
                        .schema = ros2_name,
                        .definition = message_type(topic.type, MessageEncoding::cdr).definition});
  }
  return channels;
}

/// Names of an encoding of messages in MCAP.
struct McapNames {
  const char* profile;
  const char* schemas;
  const char* messages;

  bool is_ros2() const { return std::string_view(profile) == "ros2"; }
};
constexpr McapNames kRos2Names{.profile = "ros2", .schemas = "ros2msg", .messages = "cdr"};
constexpr McapNames kJsonNames{.profile = "", .schemas = "jsonschema", .messages = "json"};

class McapWriter {
 public:
  McapWriter(const fs::path& file, const std::vector<McapChannel>& channels, const McapNames& names)
      : stream_(file), definitions_(definitions(channels, names)), counts_(channels.size(), 0) {
    stream_.write(kMcapMagic);
    stream_.write(
        record(McapOp::header, stored_text(names.profile) + stored_text("gpo-inspector")));
    stream_.write(definitions_);
    if (names.is_ros2()) write_rosbag2_metadata();
  }

  void write(int topic, std::int64_t ns, const std::string& bytes) {
    const std::uint64_t time = std::max<std::int64_t>(ns, 0);  // the format begins in 1970
    first_ = counted_ == 0 ? time : std::min(first_, time);
    last_ = std::max(last_, time);
    chunk_first_ = chunk_.empty() ? time : std::min(chunk_first_, time);
    chunk_last_ = chunk_.empty() ? time : std::max(chunk_last_, time);
    index_[topic] += stored(time) + stored<std::uint64_t>(chunk_.size());
    chunk_ += record(McapOp::message,
                     stored<std::uint16_t>(topic) + stored<std::uint32_t>(counts_[topic]) +
                         stored(time) + stored(time) + bytes);
    ++counts_[topic];
    ++counted_;
    if (chunk_.size() >= kChunkBytes) write_chunk();
  }

  void finish() {
    if (!chunk_.empty()) write_chunk();
    stream_.write(record(McapOp::data_end, stored<std::uint32_t>(0)));
    const std::uint64_t start = stream_.place();
    std::string summary = definitions_ + statistics() + chunk_indices_ + metadata_index_;
    // The checksum covers everything up to itself, including the footer's beginning.
    constexpr std::uint64_t kFooterBytes = 20;
    summary += static_cast<char>(McapOp::footer);
    summary += stored(kFooterBytes) + stored(start) + stored<std::uint64_t>(0);
    stream_.write(summary);
    stream_.write(stored(crc32_of(summary)));
    stream_.write(kMcapMagic);
    stream_.finish();
  }

 private:
  void write_rosbag2_metadata() {
    const std::uint64_t place = stream_.place();
    const std::string metadata = rosbag2_record();
    stream_.write(metadata);
    metadata_index_ =
        record(kMetadataIndex,
               stored(place) + stored<std::uint64_t>(metadata.size()) + stored_text("rosbag2"));
  }

  static std::string definitions(const std::vector<McapChannel>& channels, const McapNames& names) {
    std::string bytes;
    for (std::size_t i = 0; i < channels.size(); ++i) {
      const McapChannel& channel = channels[i];
      TextPairs metadata;
      if (names.is_ros2())
        metadata = {{"offered_qos_profiles", offered_qos_profiles(is_latched(channel.topic))}};
      bytes += record(McapOp::schema,
                      stored<std::uint16_t>(i + 1) + stored_text(channel.schema) +
                          stored_text(names.schemas) + stored_text(channel.definition));
      bytes += record(McapOp::channel,
                      stored<std::uint16_t>(i) + stored<std::uint16_t>(i + 1) +
                          stored_text(channel.topic) + stored_text(names.messages) +
                          stored_map(metadata));
    }
    return bytes;
  }

  std::string statistics() const {
    std::string counts;
    for (std::size_t i = 0; i < counts_.size(); ++i)
      counts += stored<std::uint16_t>(i) + stored(counts_[i]);
    return record(McapOp::statistics,
                  stored(counted_) + stored<std::uint16_t>(counts_.size()) +
                      stored<std::uint32_t>(counts_.size()) + stored<std::uint32_t>(0) +
                      stored<std::uint32_t>(1) + stored(chunks_) + stored(first_) + stored(last_) +
                      stored_text(counts));
  }

  void write_chunk() {
    const std::string small = compressed(chunk_);
    const std::uint64_t place = stream_.place();
    const std::string times = stored(chunk_first_) + stored(chunk_last_);
    stream_.write(record(McapOp::chunk,
                         times + stored<std::uint64_t>(chunk_.size()) + stored(crc32_of(chunk_)) +
                             stored_text("zstd") + stored_text<std::uint64_t>(small)));
    const std::uint64_t end = stream_.place();
    std::string offsets;
    for (const auto& [topic, entries] : index_) {
      offsets += stored<std::uint16_t>(topic) + stored(stream_.place());
      stream_.write(
          record(McapOp::message_index, stored<std::uint16_t>(topic) + stored_text(entries)));
    }
    chunk_indices_ +=
        record(McapOp::chunk_index,
               times + stored(place) + stored(end - place) + stored_text(offsets) +
                   stored(stream_.place() - end) + stored_text("zstd") +
                   stored<std::uint64_t>(small.size()) + stored<std::uint64_t>(chunk_.size()));
    ++chunks_;
    chunk_.clear();
    index_.clear();
  }

  ByteStream stream_;
  std::string definitions_;
  std::string metadata_index_;
  std::vector<std::uint64_t> counts_;  ///< messages by topic
  std::uint64_t counted_ = 0;
  std::uint64_t first_ = 0;
  std::uint64_t last_ = 0;
  std::uint32_t chunks_ = 0;
  std::string chunk_;
  std::map<int, std::string> index_;  ///< current chunk
  std::uint64_t chunk_first_ = 0;
  std::uint64_t chunk_last_ = 0;
  std::string chunk_indices_;
};

}  // namespace
}  // namespace mcap

BagWriter ros1_writer(const fs::path& file, const std::vector<BagTopic>& topics) {
  return bag_writer(MessageEncoding::ros1, std::make_shared<ros1::Ros1Writer>(file, topics));
}

BagWriter mcap_writer(const fs::path& file, const std::vector<BagTopic>& topics) {
  return bag_writer(
      MessageEncoding::cdr,
      std::make_shared<mcap::McapWriter>(file, mcap::ros2_channels(topics), mcap::kRos2Names));
}

BagWriter mcap_json_writer(const fs::path& file, const std::vector<McapChannel>& channels) {
  return bag_writer(MessageEncoding::json,
                    std::make_shared<mcap::McapWriter>(file, channels, mcap::kJsonNames));
}

}  // namespace gpo
