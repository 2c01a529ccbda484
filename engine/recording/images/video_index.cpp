// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/images/video_index.h"

#include <algorithm>
#include <string_view>

namespace gpo {
namespace {

constexpr int kLong = 2000;         // frames; reading all packets of shorter videos is fast
constexpr int kPlaces = 8;          // packets are compared at these and at the end
constexpr int kCompared = 16;       // packets at each place
constexpr int kMostToTheEnd = 600;  // packets from the last key frame on

/// An edit list skips trimmed frames. VP8 stores reference frames that are never shown.
bool is_hidden(const AVPacket& packet, const AVCodecParameters& codec) {
  if ((packet.flags & AV_PKT_FLAG_DISCARD) != 0) return true;
  return codec.codec_id == AV_CODEC_ID_VP8 && packet.size > 0 && (packet.data[0] & 0x10) == 0;
}

std::int64_t time_of(const AVPacket& packet) {
  return packet.pts != AV_NOPTS_VALUE ? packet.pts : packet.dts;
}

/// Compares packets with the entries.
class Comparison {
 public:
  Comparison(AVFormatContext& format, AVStream& stream, const std::vector<IndexEntry>& entries)
      : format_(format), stream_(stream), entries_(entries) {}

  /// Compares `most` packets from the key frame before an entry on. Returns the number of the entry
  /// after them; -1 if one differs.
  int read(int from, int most) {
    const std::int64_t time = entries_[from].time;
    if (libav::av_seek_frame(&format_, stream_.index, time, AVSEEK_FLAG_BACKWARD) < 0) return -1;
    int next = -1;
    for (int i = 0; i < most && libav::read_packet(format_, stream_, *packet_); ++i) {
      const std::int64_t shown = time_of(*packet_);
      if (shown == AV_NOPTS_VALUE) return -1;
      if (!shift_) shift_ = shown - entries_.front().time;
      if (next < 0) next = entry_at(shown - *shift_);
      if (next < 0 || next >= std::ssize(entries_) || !is_equal(entries_[next++])) return -1;
    }
    return next;
  }

  /// From the index's times to those of the frames, known after a call of `read`.
  std::int64_t shift() const { return shift_.value_or(0); }

 private:
  int entry_at(std::int64_t time) const {
    const auto at = std::ranges::lower_bound(entries_, time, {}, &IndexEntry::time);
    return at == entries_.end() ? -1 : static_cast<int>(at - entries_.begin());
  }
  bool is_equal(const IndexEntry& entry) const {
    const bool key = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
    const bool usual = (packet_->flags & (AV_PKT_FLAG_CORRUPT | AV_PKT_FLAG_DISCARD)) == 0;
    return usual && time_of(*packet_) == entry.time + *shift_ && packet_->size == entry.bytes &&
           key == entry.key;
  }

  AVFormatContext& format_;
  AVStream& stream_;
  const std::vector<IndexEntry>& entries_;
  libav::Packet packet_{libav::av_packet_alloc()};
  std::optional<std::int64_t> shift_;
};

}  // namespace

void PacketTimes::add(const AVPacket& packet, const AVCodecParameters& codec) {
  if (is_hidden(packet, codec)) {
    ++hidden;
    return;
  }
  if ((packet.flags & AV_PKT_FLAG_CORRUPT) != 0) {
    damaged.push_back(time_of(packet));
    return;
  }
  const bool timed = packet.pts != AV_NOPTS_VALUE;
  exact = exact && (timed || (codec.video_delay <= 0 && packet.dts != AV_NOPTS_VALUE));
  const std::int64_t time = time_of(packet);
  all.push_back(time);
  if ((packet.flags & AV_PKT_FLAG_KEY) != 0) keys.push_back(time);
  before_keys = before_keys || keys.empty() || time < keys.front();
}

void PacketTimes::finish() {
  std::ranges::sort(all);
  std::ranges::sort(keys);
  exact = exact && std::ranges::adjacent_find(all) == all.end();
}

double declared_count(const AVFormatContext& format, const AVStream& stream) {
  if (stream.nb_frames > 0) return static_cast<double>(stream.nb_frames);
  const double rate = av_q2d(stream.avg_frame_rate);
  return format.duration > 0 && rate > 0
             ? static_cast<double>(format.duration) / AV_TIME_BASE * rate
             : 0;
}

std::vector<IndexEntry> index_entries(AVFormatContext& format, AVStream& stream) {
  const std::string_view name = format.iformat->name;
  const int count = libav::avformat_index_get_entries_count(&stream);
  const bool in_order =
      stream.codecpar->video_delay <= 0 && stream.codecpar->codec_id != AV_CODEC_ID_VP8;
  const bool known = name.starts_with("mov") || name == "avi";
  const bool plausible = count >= kLong && count == stream.nb_frames &&
                         static_cast<std::uint64_t>(count) <= limits().items;
  if (!known || !in_order || !plausible) return {};
  const std::int64_t file_bytes = libav::avio_size(format.pb);
  std::vector<IndexEntry> entries;
  for (int i = 0; i < count; ++i) {
    const AVIndexEntry& entry = *libav::avformat_index_get_entry(&stream, i);
    const bool whole = entry.size > 0 && entry.pos >= 0 && entry.pos + entry.size <= file_bytes;
    const bool later = i == 0 || entry.timestamp > entries.back().time;
    if (!whole || !later || (entry.flags & AVINDEX_DISCARD_FRAME) != 0) return {};
    entries.push_back({entry.timestamp, entry.size, (entry.flags & AVINDEX_KEYFRAME) != 0});
  }
  if (!entries.front().key) return {};
  return entries;
}

std::optional<PacketTimes> indexed_times(AVFormatContext& format,
                                         AVStream& stream,
                                         const std::vector<IndexEntry>& entries) {
  const int count = static_cast<int>(entries.size());
  Comparison comparison(format, stream, entries);
  for (int place = 0; place < kPlaces; ++place)
    if (comparison.read(count / kPlaces * place, kCompared) < 0) return std::nullopt;
  if (comparison.read(count - 1, kMostToTheEnd) != count) return std::nullopt;
  PacketTimes times;
  for (const IndexEntry& entry : entries) {
    times.all.push_back(entry.time + comparison.shift());
    if (entry.key) times.keys.push_back(times.all.back());
  }
  return times;
}

}  // namespace gpo
