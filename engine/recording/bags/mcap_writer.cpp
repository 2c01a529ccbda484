// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/recording/bags/bag_writer.h"
#include "engine/recording/bags/containers/byte_stream.h"
#include "engine/recording/bags/containers/mcap.h"
#include "engine/recording/bags/containers/mcap_record.h"
#include "engine/recording/bags/message_bytes.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

namespace gpo {
namespace mcap {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{4} << 20;

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string record(McapOp op, const std::string& content) {
  std::string bytes(1, static_cast<char>(op));
  bytes += stored_text<std::uint64_t>(content);
  return bytes;
}

/// ROS 2 has three words where ROS 1 has two: "sensor_msgs/msg/Image".
std::string ros2_name(const std::string& type) {
  const std::string_view all = type;
  const auto slash = all.find('/');
  return fmt::format("{}/msg{}", all.substr(0, slash), all.substr(slash));
}

std::string compressed(const std::string& bytes) {
  std::string made(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(made.data(), made.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw InputError("zstd: cannot compress");
  made.resize(size);
  return made;
}

class McapWriter {
 public:
  McapWriter(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics)
      : stream_(file), definitions_(definitions(topics)), counts_(topics.size(), 0) {
    stream_.write(kMcapMagic);
    stream_.write(record(McapOp::header, stored_text("ros2") + stored_text("gpo-inspector")));
    stream_.write(definitions_);
  }

  void write(int topic, std::int64_t ns, const std::string& bytes) {
    const std::uint64_t time = std::max<std::int64_t>(ns, 0);  // the format has none before 1970
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
    stream_.write(record(McapOp::data_end, stored(std::uint32_t{0})));
    const std::uint64_t start = stream_.place();
    std::string summary = definitions_ + statistics() + chunk_indices_;
    // The sum is of all up to itself, also of the footer's beginning.
    constexpr std::uint64_t kFooterBytes = 20;
    summary += static_cast<char>(McapOp::footer);
    summary += stored(kFooterBytes) + stored(start) + stored(std::uint64_t{0});
    stream_.write(summary);
    stream_.write(stored(crc32_of(summary)));
    stream_.write(kMcapMagic);
    stream_.finish();
  }

 private:
  /// A schema and a channel for each topic; the schemas' numbers begin at 1.
  static std::string definitions(const std::vector<WrittenTopic>& topics) {
    std::string bytes;
    for (std::size_t i = 0; i < topics.size(); ++i) {
      const MessageType about = message_type(topics[i].type, MessageEncoding::cdr);
      bytes += record(McapOp::schema,
                      stored<std::uint16_t>(i + 1) + stored_text(ros2_name(topics[i].type)) +
                          stored_text("ros2msg") + stored_text(about.definition));
      bytes += record(McapOp::channel,
                      stored<std::uint16_t>(i) + stored<std::uint16_t>(i + 1) +
                          stored_text(topics[i].name) + stored_text("cdr") + stored_text(""));
    }
    return bytes;
  }

  std::string statistics() const {
    std::string counts;
    for (std::size_t i = 0; i < counts_.size(); ++i)
      counts += stored<std::uint16_t>(i) + stored(counts_[i]);
    return record(McapOp::statistics,
                  stored(counted_) + stored<std::uint16_t>(counts_.size()) +
                      stored<std::uint32_t>(counts_.size()) + stored(std::uint32_t{0}) +
                      stored(std::uint32_t{0}) + stored(chunks_) + stored(first_) + stored(last_) +
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
  std::vector<std::uint64_t> counts_;  ///< of messages, by topic
  std::uint64_t counted_ = 0;
  std::uint64_t first_ = 0;
  std::uint64_t last_ = 0;
  std::uint32_t chunks_ = 0;
  std::string chunk_;
  std::map<int, std::string> index_;  ///< of the chunk
  std::uint64_t chunk_first_ = 0;
  std::uint64_t chunk_last_ = 0;
  std::string chunk_indices_;
};

}  // namespace
}  // namespace mcap

BagWriter mcap_writer(const std::filesystem::path& file, const std::vector<WrittenTopic>& topics) {
  const auto writer = std::make_shared<mcap::McapWriter>(file, topics);
  return {
      MessageEncoding::cdr,
      [writer](int topic, auto ns, const std::string& bytes) { writer->write(topic, ns, bytes); },
      [writer] { writer->finish(); }};
}

}  // namespace gpo
