// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/images/libav.h"

#include <optional>
#include <vector>

namespace gpo {

/// Times of a video's packets, in units of its stream.
struct PacketTimes {
  std::vector<std::int64_t> all;
  std::vector<std::int64_t> keys;
  int hidden = 0;
  std::vector<std::int64_t> damaged;  ///< frames with incomplete data, not among `all`
  bool exact = true;                  ///< all known and different
  bool before_keys = false;  ///< whether some are before the first key frame, stored or shown

  void add(const AVPacket& packet, const AVCodecParameters& codec);
  void finish();
};

/// Returns the number of frames according to the container; 0 if unknown.
double declared_count(const AVFormatContext& format, const AVStream& stream);

struct IndexEntry {
  std::int64_t time;
  int bytes;
  bool key;
};

/// Returns the index of a long MP4, QuickTime or AVI file. Empty if it has no entry for each frame,
/// or if frames may be hidden or stored in another order than shown.
std::vector<IndexEntry> index_entries(AVFormatContext& format, AVStream& stream);

/// Returns the times from the index without reading all frames; nullopt if packets at nine places
/// of the file differ from it. Moves the reading position.
std::optional<PacketTimes> indexed_times(AVFormatContext& format,
                                         AVStream& stream,
                                         const std::vector<IndexEntry>& entries);

}  // namespace gpo
