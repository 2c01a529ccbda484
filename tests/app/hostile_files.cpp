// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/app/hostile_files.h"

#include "tests/engine/recording/images/made_video.h"

#include <vector>

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

namespace gpo::test {
namespace {

std::string text32(const std::string& text) {
  return le(static_cast<std::uint32_t>(text.size())) + text;
}

std::string zstd(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  return out;
}

std::string lz4(const std::string& bytes) {
  std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  return out;
}

std::string bz2(std::string bytes) {
  std::string out(bytes.size() / 50 + 1000, '\0');
  auto size = static_cast<unsigned>(out.size());
  BZ2_bzBuffToBuffCompress(
      out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 9, 0, 0);
  out.resize(size);
  return out;
}

// MCAP: records of a kind, a length and a content.
std::string mcap_record(char kind, const std::string& content) {
  return kind + le(std::uint64_t{content.size()}) + content;
}

std::string mcap_chunk(const std::string& compression,
                       const std::string& stored,
                       std::uint64_t size) {
  return mcap_record(6,
                     std::string(16, '\0') + le(size) + le(std::uint32_t{0}) + text32(compression) +
                         le(std::uint64_t{stored.size()}) + stored);
}

/// ROS 1: records of fields and data.
std::string ros1_record(const std::vector<std::string>& fields, const std::string& data) {
  std::string all;
  for (const std::string& field : fields) all += text32(field);
  return text32(all) + text32(data);
}

std::string png_chunk(const std::string& kind, const std::string& data) {
  const std::string summed = kind + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(summed.data()), static_cast<unsigned>(summed.size()));
  return big_endian({std::ssize(data)}, 4) + summed +
         big_endian({static_cast<std::int64_t>(sum)}, 4);
}

constexpr std::int64_t kSide = 60'000;

}  // namespace

std::string many(const std::string& text, std::size_t count) {
  std::string all;
  all.reserve(text.size() * count);
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}

std::string mcap_bomb(const std::string& compression, int chunks) {
  const std::string magic = "\x89MCAP0\r\n";
  const std::string schema = mcap_record(
      3, le(std::uint16_t{1}) + text32("sensor_msgs/msg/Image") + text32("") + text32(""));
  const std::string channel = mcap_record(
      4,
      le(std::uint16_t{1}) + le(std::uint16_t{1}) + text32("/image") + text32("cdr") + text32(""));
  const std::string messages =
      many(mcap_record(5, le(std::uint16_t{1}) + std::string(20, '\0')), 1'000'000);
  const std::string stored = compression == "zstd" ? zstd(messages) : lz4(messages);
  return magic + mcap_record(1, text32("") + text32("")) + schema + channel +
         many(mcap_chunk(compression, stored, messages.size()), chunks);
}

std::string ros1_bomb(int chunks) {
  const std::string connection =
      ros1_record({std::string("op=\x07"), "conn=" + le(std::uint32_t{0}), "topic=/image"},
                  text32("topic=/image") + text32("type=sensor_msgs/Image"));
  const std::string message = ros1_record(
      {std::string("op=\x02"), "conn=" + le(std::uint32_t{0}), "time=" + le(std::uint64_t{0})}, "");
  const std::string content = connection + many(message, 600'000);
  const std::string chunk = ros1_record({std::string("op=\x05"),
                                         "compression=bz2",
                                         "size=" + le(static_cast<std::uint32_t>(content.size()))},
                                        bz2(content));
  return "#ROSBAG V2.0\n" +
         ros1_record({std::string("op=\x03"),
                      "index_pos=" + le(std::uint64_t{0}),
                      "conn_count=" + le(std::uint32_t{0}),
                      "chunk_count=" + le(std::uint32_t{0})},
                     std::string(4000, ' ')) +
         many(chunk, chunks);
}

void write_endless_database(const std::filesystem::path& file) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  sqlite3_exec(database,
               "CREATE TABLE topics(id INTEGER, name TEXT, type TEXT, serialization_format TEXT);"
               "INSERT INTO topics VALUES(1, '/image', 'sensor_msgs/msg/Image', 'cdr');"
               "CREATE VIEW messages AS WITH RECURSIVE n(id) AS (SELECT 1 UNION ALL SELECT id + 1 "
               "FROM n) SELECT id, 1 AS topic_id, id AS timestamp, x'00' AS data FROM n;",
               nullptr,
               nullptr,
               nullptr);
  sqlite3_close(database);
}

std::string huge_png() {
  return "\x89PNG\r\n\x1A\n" +
         png_chunk("IHDR", big_endian({kSide, kSide}, 4) + std::string("\x08\x00\x00\x00\x00", 5)) +
         png_chunk("IDAT", std::string(20, 'x')) + png_chunk("IEND", "");
}

std::string huge_jpeg() {
  return "\xFF\xD8\xFF\xC0" + big_endian({11}, 2) + "\x08" + big_endian({kSide, kSide}, 2) +
         std::string("\x01\x01\x11\x00", 4) + "\xFF\xD9" + std::string(20, ' ');
}

std::string huge_tiff() {
  const auto entry = [](std::uint16_t tag, std::uint32_t value) {
    return le(tag) + le(std::uint16_t{4}) + le(std::uint32_t{1}) + le(value);
  };
  return std::string("II*\0", 4) + le(std::uint32_t{8}) + le(std::uint16_t{2}) + entry(256, kSide) +
         entry(257, kSide) + std::string(20, '\0');
}

std::string huge_webp() {
  const std::string size = le(std::uint32_t{kSide - 1}).substr(0, 3);
  return "RIFF" + le(std::uint32_t{22}) + "WEBPVP8X" + le(std::uint32_t{10}) +
         std::string(4, '\0') + size + size;
}

}  // namespace gpo::test
