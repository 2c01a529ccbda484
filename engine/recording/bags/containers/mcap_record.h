// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace gpo {

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

}  // namespace gpo
