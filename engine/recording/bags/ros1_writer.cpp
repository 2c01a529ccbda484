// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/bag_writer.h"
#include "engine/recording/bags/containers/byte_stream.h"
#include "engine/recording/bags/containers/ros1_bag.h"
#include "engine/recording/bags/containers/ros1_record.h"
#include "engine/recording/bags/message_bytes.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace gpo {
namespace ros1 {
namespace {

constexpr std::size_t kChunkBytes = 768 << 10;
constexpr std::uint32_t kHeaderBytes = 4096;  ///< of the bag's header with what fills it up

std::string field(std::string_view name, std::string_view value) {
  return stored_text(std::string(name) + "=" + std::string(value));
}

std::string op(Ros1Op op) { return field("op", std::string(1, static_cast<char>(op))); }

std::string record(const std::string& fields, const std::string& data) {
  return stored_text(fields) + stored_text(data);
}

std::string time_bytes(std::int64_t ns) {
  return stored(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
         stored(static_cast<std::uint32_t>(ns % 1'000'000'000));
}

/// The messages of a chunk by their connection.
struct Entries {
  std::uint32_t count = 0;
  std::string bytes;  ///< time and place of each
};

/// A chunk that is written, for the end of the file.
struct Info {
  std::uint64_t place;
  std::int64_t first_ns;
  std::int64_t last_ns;
  std::map<int, std::uint32_t> counts;  ///< of messages, by connection
};

class Ros1Writer {
 public:
  Ros1Writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics)
      : stream_(file), topics_(topics) {
    stream_.write(kRos1Magic);
    write_header(0);
  }

  void write(int topic, std::int64_t ns, const std::string& bytes) {
    if (chunk_.empty()) first_ns_ = last_ns_ = ns;
    first_ns_ = std::min(first_ns_, ns);
    last_ns_ = std::max(last_ns_, ns);
    if (entries_[topic].count == 0) chunk_ += connection(topic);
    Entries& entries = entries_[topic];
    ++entries.count;
    entries.bytes += time_bytes(ns) + stored(static_cast<std::uint32_t>(chunk_.size()));
    chunk_ += record(op(Ros1Op::message) + field("conn", stored<std::uint32_t>(topic)) +
                         field("time", time_bytes(ns)),
                     bytes);
    if (chunk_.size() >= kChunkBytes) write_chunk();
  }

  void finish() {
    if (!chunk_.empty()) write_chunk();
    const std::uint64_t index = stream_.place();
    for (std::size_t i = 0; i < topics_.size(); ++i) stream_.write(connection(static_cast<int>(i)));
    for (const Info& info : infos_) write_info(info);
    stream_.write_at(kRos1Magic.size(), header(index));
    stream_.finish();
  }

 private:
  std::string header(std::uint64_t index) const {
    const std::string fields =
        op(Ros1Op::bag_header) + field("index_pos", stored(index)) +
        field("conn_count", stored(static_cast<std::uint32_t>(topics_.size()))) +
        field("chunk_count", stored(static_cast<std::uint32_t>(infos_.size())));
    return record(fields, std::string(kHeaderBytes - 8 - fields.size(), ' '));
  }
  void write_header(std::uint64_t index) { stream_.write(header(index)); }

  std::string connection(int topic) const {
    const auto& [name, type] = topics_[topic];
    const MessageType about = message_type(type, MessageEncoding::ros1);
    return record(
        op(Ros1Op::connection) + field("conn", stored<std::uint32_t>(topic)) + field("topic", name),
        field("topic", name) + field("type", type) + field("md5sum", about.ros1_sum) +
            field("message_definition", about.definition));
  }

  void write_chunk() {
    Info info{stream_.place(), first_ns_, last_ns_, {}};
    stream_.write(record(op(Ros1Op::chunk) + field("compression", "none") +
                             field("size", stored(static_cast<std::uint32_t>(chunk_.size()))),
                         chunk_));
    for (const auto& [topic, entries] : entries_) {
      info.counts[topic] = entries.count;
      stream_.write(record(op(Ros1Op::index) + field("ver", stored(std::uint32_t{1})) +
                               field("conn", stored<std::uint32_t>(topic)) +
                               field("count", stored(entries.count)),
                           entries.bytes));
    }
    infos_.push_back(std::move(info));
    chunk_.clear();
    entries_.clear();
  }

  void write_info(const Info& info) {
    std::string counts;
    for (const auto& [topic, count] : info.counts)
      counts += stored<std::uint32_t>(topic) + stored(count);
    stream_.write(record(op(Ros1Op::chunk_info) + field("ver", stored(std::uint32_t{1})) +
                             field("chunk_pos", stored(info.place)) +
                             field("start_time", time_bytes(info.first_ns)) +
                             field("end_time", time_bytes(info.last_ns)) +
                             field("count", stored(static_cast<std::uint32_t>(info.counts.size()))),
                         counts));
  }

  ByteStream stream_;
  std::vector<WrittenTopic> topics_;
  std::string chunk_;
  std::map<int, Entries> entries_;  ///< of the chunk
  std::int64_t first_ns_ = 0;
  std::int64_t last_ns_ = 0;
  std::vector<Info> infos_;
};

}  // namespace
}  // namespace ros1

BagWriter ros1_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics) {
  const auto writer = std::make_shared<ros1::Ros1Writer>(file, topics);
  return {
      MessageEncoding::ros1,
      [writer](int topic, auto ns, const std::string& bytes) { writer->write(topic, ns, bytes); },
      [writer] { writer->finish(); }};
}

}  // namespace gpo
