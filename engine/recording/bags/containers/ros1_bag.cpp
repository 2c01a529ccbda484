// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/recording/bags/containers/bag.h"

#include <algorithm>

namespace gpo {
namespace ros1 {
namespace {

constexpr std::uint64_t kMostDefinitionBytes = std::uint64_t{16} << 20;

constexpr std::uint64_t kFirstRead = 512;
constexpr std::uint32_t kMostFieldBytes = 1 << 20;

std::optional<std::string_view> ros1_field(std::string_view fields, std::string_view name) {
  ByteCursor cursor(fields);
  while (cursor.more()) {
    const std::string_view field = cursor.text();
    if (field.starts_with(name) && field.substr(name.size()).starts_with('='))
      return field.substr(name.size() + 1);
  }
  return std::nullopt;
}

std::int64_t ros1_time_ns(std::uint32_t seconds, std::uint32_t nanoseconds) {
  return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
}

struct Ros1Record {
  std::string fields;
  std::uint64_t data_place = 0;
  std::uint32_t data_size = 0;

  std::uint64_t end() const { return data_place + data_size; }
  std::optional<std::string_view> field(std::string_view name) const {
    return ros1_field(fields, name);
  }
  template <class T = std::uint32_t>
  T number(std::string_view name) const {
    const auto value = field(name);
    return value && value->size() == sizeof(T) ? ByteCursor(*value).number<T>() : 0;
  }
  std::int64_t time_ns(std::string_view name) const {
    const auto both = number<std::uint64_t>(name);
    return ros1_time_ns(static_cast<std::uint32_t>(both), static_cast<std::uint32_t>(both >> 32));
  }
  bool is(Ros1Op op) const {
    const auto value = field("op");
    return value && value->size() == 1 && static_cast<Ros1Op>(value->front()) == op;
  }
};

using ReadBytes = std::function<std::string(std::uint64_t place, std::uint64_t count)>;

std::optional<Ros1Record> ros1_record(const ReadBytes& read, std::uint64_t place) {
  std::string bytes = read(place, kFirstRead);
  const auto length = ByteCursor(bytes).number<std::uint32_t>();
  if (length == 0 || length > kMostFieldBytes) return std::nullopt;
  const std::uint64_t head = std::uint64_t{length} + 8;
  if (head > bytes.size() && bytes.size() == kFirstRead) bytes = read(place, head);
  ByteCursor cursor(bytes);
  Ros1Record record;
  record.fields = cursor.text();
  record.data_size = cursor.number<std::uint32_t>();
  record.data_place = place + head;
  if (!cursor.ok()) return std::nullopt;
  return record;
}

using Opening = BagOpening;

ReadBytes reader(const Opening& opening) {
  return [&file = *opening.file](auto place, auto count) { return file.read(place, count); };
}

void add_connection(Opening& opening, const Ros1Record& record, const ReadBytes& read) {
  const std::int64_t id = record.number("conn");
  if (record.data_size > kMostDefinitionBytes || opening.topics.knows(id)) return;
  const std::string about = read(record.data_place, record.data_size);
  const auto type = ros1_field(about, "type");
  // The record's own field has the name after remapping.
  const auto name = record.field("topic");
  if (type && name) opening.topics.add(id, *name, *type, MessageEncoding::ros1);
}

Chunk chunk_of(const Opening& opening, const Ros1Record& record) {
  Chunk chunk{record.data_place, record.data_size, record.number("size")};
  const auto name = record.field("compression").value_or("none");
  const auto compression = compression_named(name);
  if (!compression)
    refuse(opening.bag.file, "found compression \"{}\", expected none, bz2 or lz4", name);
  chunk.compression = *compression;
  return chunk;
}

bool add_index(Opening& opening, std::uint32_t chunk, std::uint64_t place, std::uint64_t end) {
  while (place < end) {
    const auto record = ros1_record(reader(opening), place);
    if (!record || record->end() > end) return false;
    if (!record->is(Ros1Op::index)) return true;
    const std::int64_t connection = record->number("conn");
    const std::string entries = opening.file->read(record->data_place, record->data_size);
    ByteCursor cursor(entries);
    while (cursor.more()) {
      const auto seconds = cursor.number<std::uint32_t>();
      const auto nanoseconds = cursor.number<std::uint32_t>();
      const auto offset = cursor.number<std::uint32_t>();
      if (!cursor.ok()) return false;
      opening.topics.add_message(connection, ros1_time_ns(seconds, nanoseconds), chunk, offset);
    }
    place = record->end();
  }
  return true;
}

bool read_summary(Opening& opening, std::uint64_t place, std::vector<std::uint64_t>& chunk_places) {
  const ReadBytes read = reader(opening);
  while (place < opening.file->size()) {
    const auto record = ros1_record(read, place);
    if (!record || record->end() > opening.file->size()) return false;
    if (record->is(Ros1Op::connection)) add_connection(opening, *record, read);
    if (record->is(Ros1Op::chunk_info))
      chunk_places.push_back(record->number<std::uint64_t>("chunk_pos"));
    place = record->end();
  }
  // Repeated chunks could multiply a few bytes.
  std::ranges::sort(chunk_places);
  return std::ranges::adjacent_find(chunk_places) == chunk_places.end();
}

bool read_index(Opening& opening, const Ros1Record& header) {
  const std::uint64_t index = header.number<std::uint64_t>("index_pos");
  if (index < header.end() || index > opening.file->size()) return false;
  std::vector<std::uint64_t> places;
  if (!read_summary(opening, index, places) || places.size() != header.number("chunk_count"))
    return false;
  for (std::size_t i = 0; i < places.size(); ++i) {
    opening.report(places[i]);
    const std::uint64_t end = i + 1 < places.size() ? places[i + 1] : index;
    const auto record = ros1_record(reader(opening), places[i]);
    if (!record || !record->is(Ros1Op::chunk) || record->end() > end) return false;
    const std::uint32_t chunk = opening.chunks->add(chunk_of(opening, *record));
    if (!add_index(opening, chunk, record->end(), end)) return false;
  }
  return true;
}

bool scan_chunk(Opening& opening, std::uint32_t number) {
  const Chunk chunk = opening.chunks->chunk(number);
  Decompressed made;
  ReadBytes read = [&](auto place, auto count) {
    return place < made.bytes.size() ? made.bytes.substr(place, count) : std::string();
  };
  std::uint64_t size = std::min(chunk.stored, opening.file->size() - chunk.place);
  bool whole = size == chunk.stored;
  if (chunk.compression == Compression::none) {
    read = [&](auto place, auto count) { return opening.chunks->read(number, place, count); };
  } else {
    made = opening.chunks->contents(number);
    size = made.bytes.size();
    whole = made.whole;
    if (!whole) opening.chunks->allow_truncation(number);
  }
  std::uint64_t place = 0;
  while (place < size) {
    const auto record = ros1_record(read, place);
    if (!record || record->end() > size) return false;
    if (record->is(Ros1Op::connection)) add_connection(opening, *record, read);
    if (record->is(Ros1Op::message))
      opening.topics.add_message(record->number("conn"), record->time_ns("time"), number, place);
    place = record->end();
  }
  return whole;
}

void scan(Opening& opening, std::uint64_t place) {
  const ReadBytes read = reader(opening);
  while (place < opening.file->size()) {
    opening.report(place);
    const auto record = ros1_record(read, place);
    if (!record) break;
    if (record->is(Ros1Op::connection)) add_connection(opening, *record, read);
    const bool scanned = !record->is(Ros1Op::chunk) ||
                         scan_chunk(opening, opening.chunks->add(chunk_of(opening, *record)));
    if (!scanned || record->end() > opening.file->size()) break;
    place = record->end();
  }
  const bool whole = place == opening.file->size();
  opening.bag.notes.push_back(whole ? "the bag has no index: read the whole file"
                                    : truncation_note(*opening.file, place));
}

DataPlace find_data(const ChunkReader& chunks, const BagMessage& message, bool /*check_sum*/) {
  const ReadBytes read = [&](auto place, auto count) {
    return chunks.read(message.chunk, place, count);
  };
  const auto record = ros1_record(read, message.place);
  if (!record || !record->is(Ros1Op::message) || record->data_size > kMostMessageBytes) return {};
  return {record->data_place, record->data_size};
}

}  // namespace
}  // namespace ros1

Bag open_ros1_bag(const std::shared_ptr<const FileBytes>& file, const ReadProgress& progress) {
  using namespace ros1;
  Opening opening(file, progress);
  const auto header = ros1_record(reader(opening), kRos1Magic.size());
  if (!header || !header->is(Ros1Op::bag_header))
    refuse(opening.bag.file, "found no header of a ROS 1 bag at byte {}", kRos1Magic.size());
  if (!read_index(opening, *header)) {
    opening.bag.messages.clear();
    opening.chunks->clear();
    scan(opening, header->end());
  }
  return opening.finish(find_data);
}

}  // namespace gpo
