// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/recording/loggers/logs.h"
#include "engine/recording/images/libav.h"
#include "engine/recording/refuse.h"

#include <array>
#include <bit>
#include <memory>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{256} << 20;

std::string tag_of(const AVStream& stream) {
  const unsigned tag = stream.codecpar->codec_tag;
  std::string letters;
  for (int k = 0; k < 4; ++k) letters += static_cast<char>(tag >> 8 * k & 0xFF);
  return letters;
}

/// Returns the first telemetry track, and disables all others.
AVStream* telemetry_stream(AVFormatContext& format) {
  AVStream* found = nullptr;
  for (unsigned i = 0; i < format.nb_streams; ++i) {
    AVStream* stream = format.streams[i];
    const std::string tag = tag_of(*stream);
    if (found == nullptr && (tag == "gpmd" || tag == "camm"))
      found = stream;
    else
      stream->discard = AVDISCARD_ALL;
  }
  return found;
}

constexpr std::size_t kHead = 4;  // two reserved bytes, two with the kind
constexpr std::uint64_t kExposure = 1;
constexpr std::uint64_t kGyroscope = 2;

using Bytes = std::string_view;

constexpr std::uint64_t kMostBoxBytes = 1 << 20;
constexpr int kMostBoxes = 10'000;

std::uint64_t number_of(Bytes bytes) { return big_endian(bytes, 0, bytes.size()); }

/// A box in memory; for a key the kind is its namespace.
struct MemoryBox {
  Bytes kind;
  Bytes data;
};

/// Takes a box off the front of its container; nullopt at the end, and if it is truncated.
std::optional<MemoryBox> take_box(Bytes& rest) {
  constexpr std::size_t kHead = 8;
  if (rest.size() < kHead) return std::nullopt;
  const std::uint64_t length = number_of(rest.substr(0, 4));
  if (length < kHead || length > rest.size()) return std::nullopt;
  const MemoryBox box{rest.substr(4, 4), rest.substr(kHead, length - kHead)};
  rest.remove_prefix(length);
  return box;
}

Bytes data_in(Bytes outer, Bytes kind) {
  while (const auto box = take_box(outer))
    if (box->kind == kind) return box->data;
  return {};
}

/// Returns a key's place in the list, from 1, which is the kind of its value's box; 0 if missing.
std::uint64_t place_of(Bytes keys, Bytes key) {
  constexpr std::size_t kVersionAndCount = 8;
  if (keys.size() < kVersionAndCount) return 0;
  keys.remove_prefix(kVersionAndCount);
  for (std::uint64_t place = 1; const auto found = take_box(keys); ++place)
    if (found->kind == "mdta" && found->data == key) return place;
  return 0;
}

/// Converts a value according to the table of "well-known types".
std::optional<std::string> text_of(std::uint64_t type, Bytes value) {
  enum { kUtf8 = 1, kSigned = 21, kUnsigned = 22, kFloat = 23, kDouble = 24 };
  const std::uint64_t bits = number_of(value.substr(0, 8));
  const bool is_number = !value.empty() && value.size() <= 8;
  if (type == kUtf8) return std::string(value.substr(0, value.find('\0')));
  if (type == kUnsigned && is_number) return std::to_string(bits);
  if (type == kSigned && is_number) {
    const auto unused = static_cast<int>(64 - 8 * value.size());
    return std::to_string(static_cast<std::int64_t>(bits << unused) >> unused);
  }
  if (type == kFloat && value.size() == 4)
    return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (type == kDouble && value.size() == 8) return fmt::format("{}", std::bit_cast<double>(bits));
  return std::nullopt;
}

}  // namespace

std::optional<TelemetryTrack> read_telemetry_track(const fs::path& video) {
  const libav::Format format = libav::open_input(video, "mov");
  AVStream* stream = format ? telemetry_stream(*format) : nullptr;
  if (stream == nullptr) return std::nullopt;
  TelemetryTrack track{tag_of(*stream), {}};
  const double unit_s = av_q2d(stream->time_base);
  const libav::Packet packet(av_packet_alloc());
  std::size_t bytes = 0;
  for (; av_read_frame(format.get(), packet.get()) >= 0; av_packet_unref(packet.get())) {
    if (packet->stream_index != stream->index || packet->pts == AV_NOPTS_VALUE) continue;
    bytes += static_cast<std::size_t>(packet->size) + sizeof(TelemetryPacket);
    if (bytes > kMostBytes) refuse(video, "the telemetry is larger than {} MiB", kMostBytes >> 20);
    const auto begin = static_cast<double>(packet->pts);
    track.packets.push_back(
        {unit_s * begin,
         unit_s * (begin + static_cast<double>(packet->duration)),
         std::string(reinterpret_cast<const char*>(packet->data), packet->size)});
  }
  return track;
}

std::string gopro_settings(const fs::path& video) {
  MovieFile movie(video);
  const auto box = movie.box_at({"moov", "udta", "GPMF"});
  return box ? movie.bytes_of(*box) : "";
}

CammSample parse_camm(std::string_view bytes, const std::string& source) {
  const auto need = [&](std::size_t length) {
    if (bytes.size() >= length) return;
    refuse(source, "found a sample of {} bytes (truncated), expected {}", bytes.size(), length);
  };
  need(kHead);
  CammSample sample;
  const std::uint64_t kind = little_endian(bytes, 2, 2);
  if (kind == kExposure) {
    need(kHead + 8);
    const auto skew_ns = static_cast<std::int32_t>(little_endian(bytes, kHead + 4, 4));
    sample.readout_s = 1e-9 * skew_ns;
  }
  if (kind == kGyroscope) {
    need(kHead + 12);
    Eigen::Vector3d rates;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto bits = static_cast<std::uint32_t>(little_endian(bytes, kHead + 4 * k, 4));
      rates[static_cast<int>(k)] = static_cast<double>(std::bit_cast<float>(bits));
    }
    if (!rates.allFinite()) refuse(source, "a rate is not finite");
    sample.rates_rad_s = rates;
  }
  return sample;
}

MovieFile::MovieFile(const std::filesystem::path& file) : file_(file, std::ios::binary) {
  std::error_code error;
  const std::uint64_t size = std::filesystem::file_size(file, error);
  if (!error && file_) all_.end = size;
}

std::optional<MovieBox> MovieFile::box_in(MovieBox outer, std::string_view kind) {
  std::array<char, 16> head{};
  for (int k = 0; k < kMostBoxes && outer.begin + 8 <= outer.end; ++k) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(outer.begin));
    if (!file_.read(head.data(), 8)) return std::nullopt;
    std::uint64_t length = number_of({head.data(), 4});
    std::uint64_t head_length = 8;
    if (length == 1 && file_.read(head.data() + 8, 8)) {
      length = number_of({head.data() + 8, 8});
      head_length = 16;
    }
    if (length == 0) length = outer.end - outer.begin;
    if (length < head_length || length > outer.end - outer.begin) return std::nullopt;
    if (std::string_view(head.data() + 4, 4) == kind)
      return MovieBox{outer.begin + head_length, outer.begin + length};
    outer.begin += length;
  }
  return std::nullopt;
}

std::optional<MovieBox> MovieFile::box_at(std::initializer_list<std::string_view> kinds) {
  std::optional<MovieBox> box = all_;
  for (const std::string_view kind : kinds)
    if (box) box = box_in(*box, kind);
  return box;
}

std::string MovieFile::bytes_of(MovieBox box) {
  if (box.end - box.begin > kMostBoxBytes) return "";
  std::string bytes(box.end - box.begin, '\0');
  file_.clear();
  file_.seekg(static_cast<std::streamoff>(box.begin));
  return file_.read(bytes.data(), static_cast<std::streamsize>(bytes.size())) ? bytes : "";
}

std::optional<std::string> metadata_value(Bytes meta, Bytes key) {
  // QuickTime's content begins with its first box, MPEG's with a version.
  if (meta.size() >= 12 && meta.substr(4, 4) != "hdlr" && meta.substr(8, 4) == "hdlr")
    meta.remove_prefix(4);
  const std::uint64_t place = place_of(data_in(meta, "keys"), key);
  Bytes values = data_in(meta, "ilst");
  while (const auto value = place > 0 ? take_box(values) : std::nullopt) {
    if (number_of(value->kind) != place) continue;
    const Bytes data = data_in(value->data, "data");
    constexpr std::size_t kTypeAndLocale = 8;
    if (data.size() < kTypeAndLocale) return std::nullopt;
    return text_of(number_of(data.substr(0, 4)), data.substr(kTypeAndLocale));
  }
  return std::nullopt;
}

}  // namespace gpo
