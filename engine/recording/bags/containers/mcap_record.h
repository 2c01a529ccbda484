// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace gpo {

class FileBytes;

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

/// A record in a file; its content need not be there to its end.
struct McapRecord {
  McapOp op{};
  std::uint64_t place = 0;  ///< of its content
  std::uint64_t size = 0;   ///< of its content

  std::uint64_t end() const { return place + size; }
};

/// The one that begins at `place`; nothing where the file ends before its content, or the content
/// is larger than any file.
std::optional<McapRecord> mcap_record(const FileBytes& file, std::uint64_t place);

/// False where the last one is cut; it is not handed on.
bool for_each_mcap_record(std::string_view records,
                          const std::function<void(McapOp op, std::string_view content)>& look);

}  // namespace gpo
