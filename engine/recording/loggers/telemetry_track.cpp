// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/telemetry_track.h"

#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"
#include "engine/recording/pictures/libav.h"
#include "engine/recording/pictures/movie_boxes.h"

#include <bit>
#include <cstdint>
#include <memory>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{256} << 20;

/// The letters of a codec's tag.
std::string tag_of(const AVStream& stream) {
  const unsigned tag = stream.codecpar->codec_tag;
  std::string letters;
  for (int k = 0; k < 4; ++k) letters += static_cast<char>(tag >> 8 * k & 0xFF);
  return letters;
}

/// The first telemetry track; all others are passed over when packets are read.
AVStream* telemetry_stream(AVFormatContext& format) {
  AVStream* found = nullptr;
  for (unsigned i = 0; i < format.nb_streams; ++i) {
    AVStream* stream = format.streams[i];
    const std::string tag = tag_of(*stream);
    if (found == nullptr && (tag == "gpmd" || tag == "camm")) {
      found = stream;
    } else {
      stream->discard = AVDISCARD_ALL;
    }
  }
  return found;
}

constexpr std::size_t kHead = 4;  // two bytes that are reserved, two that tell the kind
constexpr std::uint64_t kExposure = 1;
constexpr std::uint64_t kGyroscope = 2;

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
    if (bytes > kMostBytes) {
      throw InputError(fmt::format("{}: found more than {} MiB of telemetry, expected less",
                                   video.string(),
                                   kMostBytes >> 20));
    }
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
    throw InputError(fmt::format(
        "{}: found a sample of {} bytes (cut), expected {}", source, bytes.size(), length));
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
    if (!rates.allFinite()) {
      throw InputError(
          fmt::format("{}: found a rate that is not finite, expected three numbers", source));
    }
    sample.rates_rad_s = rates;
  }
  return sample;
}

}  // namespace gpo
