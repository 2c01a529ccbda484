// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/bags/containers/mcap_record.h"

#include "engine/files/byte_cursor.h"
#include "engine/recording/bags/containers/file_bytes.h"

namespace gpo {

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

bool for_each_mcap_record(std::string_view records,
                          const std::function<void(McapOp op, std::string_view content)>& look) {
  ByteCursor cursor(records);
  while (cursor.more()) {
    const auto op = static_cast<McapOp>(cursor.number<std::uint8_t>());
    const std::string_view content = cursor.text<std::uint64_t>();
    if (!cursor.ok()) return false;
    look(op, content);
  }
  return true;
}

}  // namespace gpo
