// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/recording/bags/containers/bag.h"

#include <algorithm>
#include <array>

namespace gpo {
namespace mcap {
namespace {

constexpr std::uint64_t kFooterBytes = 20;
constexpr std::uint64_t kMostSummaryBytes = std::uint64_t{256} << 20;
constexpr std::uint64_t kMostDefinitionBytes = std::uint64_t{16} << 20;
constexpr std::uint64_t kLongestMessageHead = 22;  ///< channel, sequence, two times

struct McapRecord {
  McapOp op{};
  std::uint64_t place = 0;  ///< begin of the content
  std::uint64_t size = 0;   ///< length of the content

  std::uint64_t end() const { return place + size; }
};

std::optional<McapRecord> mcap_record(const FileBytes& file, std::uint64_t place) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 62;
  const std::string head = file.read(place, kMcapRecordHead);
  ByteCursor cursor(head);
  McapRecord record;
  record.op = static_cast<McapOp>(cursor.number<std::uint8_t>());
  record.size = cursor.number<std::uint64_t>();
  record.place = place + kMcapRecordHead;
  if (!cursor.ok() || record.size > kMostBytes) return std::nullopt;
  return record;
}

/// Calls `visit` for each complete record. Returns false if the last one is truncated.
bool for_each_mcap_record(std::string_view records,
                          const std::function<void(McapOp op, std::string_view content)>& visit) {
  ByteCursor cursor(records);
  while (cursor.more()) {
    const auto op = static_cast<McapOp>(cursor.number<std::uint8_t>());
    const std::string_view content = cursor.text<std::uint64_t>();
    if (!cursor.ok()) return false;
    visit(op, content);
  }
  return true;
}

struct ChunkEntry {
  std::uint64_t place = 0;
  std::uint64_t length = 0;        ///< including the record's head
  std::uint64_t index_length = 0;  ///< length of the index records behind it
};

struct Opening : BagOpening {
  Opening(const std::shared_ptr<const FileBytes>& from, const ReadProgress& progress)
      : BagOpening(from, progress) {
    chunks->add({0, from->size(), from->size()});  // for messages outside of all chunks
  }

  std::map<std::uint16_t, std::string> schemas;  ///< names
};

void add_definition(Opening& opening, McapOp op, std::string_view content) {
  ByteCursor cursor(content);
  const auto id = cursor.number<std::uint16_t>();
  if (op == McapOp::schema) {
    const std::string_view name = cursor.text();
    if (cursor.ok() && id != 0) opening.schemas.emplace(id, name);
  }
  if (op != McapOp::channel) return;
  const auto schema = opening.schemas.find(cursor.number<std::uint16_t>());
  const std::string_view topic = cursor.text();
  const std::string_view name = cursor.text();
  if (!cursor.ok()) return;
  const std::string type = schema == opening.schemas.end() ? "" : schema->second;
  constexpr std::array<std::pair<std::string_view, MessageEncoding>, 4> kEncodings = {
      {{"cdr", MessageEncoding::cdr},
       {"ros1", MessageEncoding::ros1},
       {"protobuf", MessageEncoding::protobuf},
       {"json", MessageEncoding::json}}};
  const auto known = std::ranges::find(kEncodings, name, [](const auto& one) { return one.first; });
  opening.topics.add(
      id, topic, type, known == kEncodings.end() ? MessageEncoding::unknown : known->second);
}

ChunkEntry chunk_entry(std::string_view content) {
  ByteCursor cursor(content);
  cursor.take(16);  // times
  ChunkEntry entry;
  entry.place = cursor.number<std::uint64_t>();
  entry.length = cursor.number<std::uint64_t>();
  cursor.text();  // places of the channels' indices
  entry.index_length = cursor.number<std::uint64_t>();
  return cursor.ok() ? entry : ChunkEntry{};
}

std::optional<std::string> summary_bytes(const FileBytes& file) {
  const std::uint64_t tail = kMcapRecordHead + kFooterBytes + kMcapMagic.size();
  if (file.size() < kMcapMagic.size() + tail) return std::nullopt;
  const std::uint64_t footer = file.size() - tail;
  const std::string end = file.read(footer, tail);
  ByteCursor cursor(end);
  const bool is_footer = cursor.number<std::uint8_t>() == static_cast<int>(McapOp::footer) &&
                         cursor.number<std::uint64_t>() == kFooterBytes &&
                         end.ends_with(kMcapMagic);
  const auto start = cursor.number<std::uint64_t>();
  cursor.number<std::uint64_t>();
  const auto expected_sum = cursor.number<std::uint32_t>();
  if (!is_footer || start == 0 || start > footer || footer - start > kMostSummaryBytes)
    return std::nullopt;
  // The checksum covers the summary and the footer up to the checksum itself.
  std::string bytes = file.read(start, file.size() - kMcapMagic.size() - 4 - start);
  if (expected_sum != 0 && crc32_of(bytes) != expected_sum) return std::nullopt;
  bytes.resize(footer - start);
  return bytes;
}

std::optional<Chunk> chunk_at(const Opening& opening, const McapRecord& record) {
  const std::string head =
      opening.file->read(record.place, std::min<std::uint64_t>(record.size, 256));
  ByteCursor cursor(head);
  cursor.take(16);  // times
  Chunk chunk;
  chunk.size = cursor.number<std::uint64_t>();
  chunk.crc32 = cursor.number<std::uint32_t>();
  const std::string_view name = cursor.text();
  chunk.stored = cursor.number<std::uint64_t>();
  chunk.place = record.place + cursor.place();
  if (!cursor.ok() || chunk.stored > record.size) return std::nullopt;
  const auto compression = compression_named(name);
  if (!compression || *compression == Compression::bz2)
    refuse(opening.bag.file, "found compression \"{}\", expected none, lz4 or zstd", name);
  chunk.compression = *compression;
  return chunk;
}

bool add_index(Opening& opening, std::uint32_t chunk, const std::string& records) {
  bool whole = true;
  const bool read = for_each_mcap_record(records, [&](McapOp op, std::string_view content) {
    if (op != McapOp::message_index) return;
    ByteCursor cursor(content);
    const auto channel = cursor.number<std::uint16_t>();
    ByteCursor entries(cursor.text());
    whole = whole && opening.topics.knows(channel);
    while (entries.more()) {
      const auto time = entries.number<std::int64_t>();
      const auto place = entries.number<std::uint64_t>();
      if (entries.ok()) opening.topics.add_message(channel, time, chunk, place);
    }
    whole = whole && cursor.ok() && entries.ok();
  });
  return read && whole;
}

bool read_index(Opening& opening) {
  const auto bytes = summary_bytes(*opening.file);
  if (!bytes) return false;
  std::vector<ChunkEntry> chunks;
  std::optional<std::uint64_t> messages;  // in the whole file
  for_each_mcap_record(*bytes, [&](McapOp op, std::string_view content) {
    add_definition(opening, op, content);
    if (op == McapOp::chunk_index) chunks.push_back(chunk_entry(content));
    if (op == McapOp::statistics) messages = ByteCursor(content).number<std::uint64_t>();
  });
  std::ranges::sort(chunks, {}, &ChunkEntry::place);
  std::uint64_t free = kMcapMagic.size();  // overlapping chunks could multiply a few bytes
  for (const ChunkEntry& entry : chunks) {
    opening.report(entry.place);
    const std::uint64_t left = opening.file->size() - std::min(entry.place, opening.file->size());
    if (entry.place < free || entry.length > left || entry.index_length == 0 ||
        entry.index_length > left - entry.length)
      return false;
    const auto record = mcap_record(*opening.file, entry.place);
    if (!record || record->op != McapOp::chunk || record->end() != entry.place + entry.length)
      return false;
    const auto chunk = chunk_at(opening, *record);
    const std::string index = opening.file->read(record->end(), entry.index_length);
    if (!chunk || !add_index(opening, opening.chunks->add(*chunk), index)) return false;
    free = record->end() + entry.index_length;
  }
  return messages ? *messages == opening.bag.messages.size() : !chunks.empty();
}

void add_message(Opening& opening,
                 std::string_view head,
                 std::uint32_t chunk,
                 std::uint64_t place) {
  ByteCursor cursor(head);
  const auto channel = cursor.number<std::uint16_t>();
  cursor.number<std::uint32_t>();
  const auto time = cursor.number<std::int64_t>();
  if (cursor.ok()) opening.topics.add_message(channel, time, chunk, place);
}

bool scan_chunk(Opening& opening, const Chunk& chunk) {
  const std::uint32_t number = opening.chunks->add(chunk);
  const Decompressed made = opening.chunks->contents(number);
  if (!made.whole) opening.chunks->allow_truncation(number);
  const bool read = for_each_mcap_record(made.bytes, [&](McapOp op, std::string_view content) {
    add_definition(opening, op, content);
    if (op != McapOp::message) return;
    const std::uint64_t place = content.data() - made.bytes.data() - kMcapRecordHead;
    add_message(opening, content, number, place);
  });
  return read && made.whole;
}

/// Scans a record outside of chunks; false if it is truncated or broken.
bool scan_record(Opening& opening, const McapRecord& record) {
  if (record.op == McapOp::chunk) {
    const auto chunk = chunk_at(opening, record);
    if (!chunk || !scan_chunk(opening, *chunk)) return false;
  }
  if (record.end() > opening.file->size()) return false;
  const bool definition = record.op == McapOp::schema || record.op == McapOp::channel;
  const std::uint64_t wanted = definition ? kMostDefinitionBytes : kLongestMessageHead;
  if (!definition && record.op != McapOp::message) return true;
  const std::string content = opening.file->read(record.place, std::min(record.size, wanted));
  add_definition(opening, record.op, content);
  if (record.op == McapOp::message)
    add_message(opening, content, 0, record.place - kMcapRecordHead);
  return true;
}

void scan(Opening& opening) {
  std::uint64_t place = kMcapMagic.size();
  bool ended = false;
  while (!ended) {
    opening.report(place);
    const auto record = mcap_record(*opening.file, place);
    if (!record || !scan_record(opening, *record)) break;
    ended = record->op == McapOp::data_end || record->op == McapOp::footer;
    place = record->end();
  }
  opening.bag.notes.push_back(ended ? "the bag has no complete index: read the whole file"
                                    : truncation_note(*opening.file, place));
}

DataPlace find_data(const ChunkReader& chunks, const BagMessage& message, bool check_sum) {
  const std::uint64_t before = kMcapRecordHead + kLongestMessageHead;
  const std::string head = chunks.read(message.chunk, message.place, before, check_sum);
  ByteCursor cursor(head);
  const bool is_message = cursor.number<std::uint8_t>() == static_cast<int>(McapOp::message);
  const auto length = cursor.number<std::uint64_t>();
  if (!is_message || length <= kLongestMessageHead || length > kMostMessageBytes) return {};
  return {message.place + before, length - kLongestMessageHead};
}

}  // namespace
}  // namespace mcap

Bag open_mcap(const std::shared_ptr<const FileBytes>& file, const ReadProgress& progress) {
  using namespace mcap;
  Opening opening(file, progress);
  if (!read_index(opening)) {
    opening.bag.messages.clear();
    scan(opening);
  }
  return opening.finish(find_data);
}

}  // namespace gpo
