// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/recording/loggers/telemetry_video.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

extern "C" {
#include <libavformat/avformat.h>
}

namespace gpo::test {
namespace {

namespace fs = std::filesystem;

void demand(int result, const char* what) {
  if (result < 0) throw std::runtime_error(what);
}

std::string all_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// FFmpeg knows one kind of telemetry to write; the other differs by its name only.
void rename_track(const fs::path& file, const std::string& format) {
  std::string bytes = all_of(file);
  for (std::size_t at = 0; (at = bytes.find("gpmd", at)) != std::string::npos; at += 4)
    bytes.replace(at, 4, format);
  std::ofstream(file, std::ios::binary) << bytes;
}

/// How a player turns the pictures; later versions of FFmpeg have it among the parameters.
void copy_side_data([[maybe_unused]] const AVStream& from, [[maybe_unused]] AVStream& to) {
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)  // see ffmpeg_versions.h
  for (int i = 0; i < from.nb_side_data; ++i) {
    const AVPacketSideData& data = from.side_data[i];
    std::memcpy(av_stream_new_side_data(&to, data.type, data.size), data.data, data.size);
  }
#endif
}

template <class Number>
std::string little_endian(Number number) {
  std::string bytes(sizeof(number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

}  // namespace

void add_telemetry(const fs::path& video,
                   const std::string& format,
                   const std::vector<TelemetryPiece>& pieces) {
  AVFormatContext* from = nullptr;
  demand(avformat_open_input(&from, video.c_str(), nullptr, nullptr), "no video");
  const fs::path made = video.string() + ".mp4";
  AVFormatContext* to = nullptr;
  demand(avformat_alloc_output_context2(&to, nullptr, "mp4", made.c_str()), "no container");
  AVStream* images = avformat_new_stream(to, nullptr);
  demand(avcodec_parameters_copy(images->codecpar, from->streams[0]->codecpar), "no copy");
  images->codecpar->codec_tag = 0;
  copy_side_data(*from->streams[0], *images);
  images->time_base = from->streams[0]->time_base;
  AVStream* telemetry = avformat_new_stream(to, nullptr);
  telemetry->codecpar->codec_type = AVMEDIA_TYPE_DATA;
  telemetry->codecpar->codec_id = AV_CODEC_ID_BIN_DATA;
  telemetry->codecpar->codec_tag = MKTAG('g', 'p', 'm', 'd');
  telemetry->time_base = {1, 1000};
  demand(avio_open(&to->pb, made.c_str(), AVIO_FLAG_WRITE), "no file");
  demand(avformat_write_header(to, nullptr), "no header");
  AVPacket* packet = av_packet_alloc();
  while (av_read_frame(from, packet) >= 0) {
    av_packet_rescale_ts(packet, from->streams[0]->time_base, images->time_base);
    packet->stream_index = 0;
    demand(av_interleaved_write_frame(to, packet), "cannot write");
  }
  for (const TelemetryPiece& piece : pieces) {
    demand(av_new_packet(packet, static_cast<int>(piece.bytes.size())), "no memory");
    std::memcpy(packet->data, piece.bytes.data(), piece.bytes.size());
    packet->pts = packet->dts = piece.time_ms;
    packet->duration = piece.length_ms;
    packet->flags |= AV_PKT_FLAG_KEY;
    packet->stream_index = 1;
    av_packet_rescale_ts(packet, {1, 1000}, telemetry->time_base);
    demand(av_interleaved_write_frame(to, packet), "cannot write");
  }
  av_packet_free(&packet);
  av_write_trailer(to);
  avio_closep(&to->pb);
  avformat_free_context(to);
  avformat_close_input(&from);
  fs::rename(made, video);
  if (format != "gpmd") rename_track(video, format);
}

std::string gpmf_item(const std::string& key, char type, int size, const std::string& data) {
  std::string item = key + type + static_cast<char>(size);
  const std::size_t count = data.size() / static_cast<std::size_t>(size);
  item += static_cast<char>(count >> 8);
  item += static_cast<char>(count & 0xFF);
  item += data;
  item.resize((item.size() + 3) / 4 * 4, '\0');
  return item;
}

std::string big_endian(const std::vector<std::int64_t>& values, int size) {
  std::string bytes;
  for (const std::int64_t value : values)
    for (int k = size - 1; k >= 0; --k) bytes += static_cast<char>(value >> 8 * k & 0xFF);
  return bytes;
}

std::string camm_rates(float x, float y, float z) {
  return little_endian<std::uint16_t>(0) + little_endian<std::uint16_t>(2) + little_endian(x) +
         little_endian(y) + little_endian(z);
}

std::string camm_exposure(std::int32_t exposure_ns, std::int32_t skew_ns) {
  return little_endian<std::uint16_t>(0) + little_endian<std::uint16_t>(1) +
         little_endian(exposure_ns) + little_endian(skew_ns);
}

}  // namespace gpo::test
