// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/recording/images/made_video.h"

#include "engine/recording/images/libav.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include <opencv2/imgproc.hpp>

namespace gpo::libav {

// Only tests use these.
inline const Function<decltype(::av_display_rotation_set)> av_display_rotation_set{
    "av_display_rotation_set"};
inline const Function<decltype(::avcodec_find_encoder_by_name)> avcodec_find_encoder_by_name{
    "avcodec_find_encoder_by_name"};
inline const Function<decltype(::av_interleaved_write_frame)> av_interleaved_write_frame{
    "av_interleaved_write_frame"};
inline const Function<decltype(::av_log_set_level)> av_log_set_level{"av_log_set_level"};
inline const Function<decltype(::av_new_packet)> av_new_packet{"av_new_packet"};
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)  // see libav_functions.h
inline const Function<decltype(::av_stream_new_side_data)> av_stream_new_side_data{
    "av_stream_new_side_data"};
#else
inline const Function<decltype(::av_packet_side_data_new)> av_packet_side_data_new{
    "av_packet_side_data_new"};
#endif

}  // namespace gpo::libav

namespace gpo::test {
namespace {

namespace fs = std::filesystem;

constexpr AVRational kMillisecond = {1, 1000};
constexpr AVRational kFrame = {1, 25};

void check(int result, const char* what) {
  if (result < 0) throw std::runtime_error(what);
}

void close_output(AVFormatContext** format) {
  libav::avio_closep(&(*format)->pb);
  libav::avformat_free_context(*format);
}
using Output = std::unique_ptr<AVFormatContext, libav::Closer<close_output>>;

AVCodecID codec_of(const fs::path& file, const VideoOptions& options) {
  if (file.extension() == ".ts") return AV_CODEC_ID_MPEG2VIDEO;  // repeats its headers
  return options.b_frames ? AV_CODEC_ID_MPEG4 : AV_CODEC_ID_MJPEG;
}

libav::Codec open_encoder(const cv::Mat& image, const fs::path& file, const VideoOptions& options) {
  const AVCodec* codec = options.codec.empty()
                             ? libav::avcodec_find_encoder(codec_of(file, options))
                             : libav::avcodec_find_encoder_by_name(options.codec.c_str());
  check(codec == nullptr ? -1 : 0, "no such encoder");
  const AVCodecID id = codec->id;
  const bool b_frames = id != AV_CODEC_ID_MJPEG;
  const AVRational time_base = options.times_ms.empty() ? kFrame : kMillisecond;
  libav::Codec encoder(libav::avcodec_alloc_context3(codec));
  encoder->width = image.cols;
  encoder->height = image.rows;
  encoder->pix_fmt = b_frames ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUVJ420P;
  encoder->sample_aspect_ratio = {options.pixel_aspect.first, options.pixel_aspect.second};
  encoder->time_base = time_base;
  encoder->bit_rate = 4'000'000;
  encoder->gop_size = b_frames ? 12 : 1;
  encoder->max_b_frames = b_frames && options.codec.empty() ? 2 : 0;
  if (options.pq) {
    encoder->pix_fmt = AV_PIX_FMT_YUV420P10;
    encoder->color_trc = AVCOL_TRC_SMPTE2084;
    encoder->color_primaries = AVCOL_PRI_BT2020;
    encoder->colorspace = AVCOL_SPC_BT2020_NCL;
  }
  if (id != AV_CODEC_ID_MPEG2VIDEO) encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  if (options.full_range) encoder->color_range = AVCOL_RANGE_JPEG;
  if (options.top_field_first) {
    encoder->flags |= AV_CODEC_FLAG_INTERLACED_DCT | AV_CODEC_FLAG_INTERLACED_ME;
    encoder->field_order = *options.top_field_first ? AV_FIELD_TT : AV_FIELD_BB;
  }
  AVDictionary* settings = nullptr;
  if (options.pq) libav::av_dict_set(&settings, "lossless", "1", 0);
  check(libav::avcodec_open2(encoder.get(), codec, &settings), "no encoder");
  libav::av_dict_free(&settings);
  return encoder;
}

libav::Frame frame_of(const cv::Mat& image, const AVCodecContext& encoder, std::int64_t time) {
  cv::Mat yuv;
  cv::cvtColor(image, yuv, cv::COLOR_BGR2YUV_I420);
  libav::Frame frame(libav::av_frame_alloc());
  frame->width = encoder.width;
  frame->height = encoder.height;
  frame->format = encoder.pix_fmt;
  check(libav::av_frame_get_buffer(frame.get(), 0), "no memory");
  const std::uint8_t* from = yuv.data;
  for (int plane = 0; plane < 3; ++plane) {
    const int half = plane == 0 ? 1 : 2, width = image.cols / half;
    for (int row = 0; row < image.rows / half; ++row, from += width) {
      std::uint8_t* to = frame->data[plane] + row * frame->linesize[plane];
      if (encoder.pix_fmt == AV_PIX_FMT_YUV420P10)
        std::transform(from, from + width, reinterpret_cast<std::uint16_t*>(to), [](int value) {
          return static_cast<std::uint16_t>(4 * value);
        });
      else
        std::copy_n(from, width, to);
    }
  }
  frame->pts = time;
  return frame;
}

void declare_fields(AVFrame& frame, bool top_first) {
#if LIBAVUTIL_VERSION_INT < AV_VERSION_INT(58, 7, 100)  // Debian 12 has 57, Debian 13 has 59
  frame.interlaced_frame = 1;
  frame.top_field_first = top_first ? 1 : 0;
#else
  frame.flags |= AV_FRAME_FLAG_INTERLACED | (top_first ? AV_FRAME_FLAG_TOP_FIELD_FIRST : 0);
#endif
}

void drain(AVCodecContext* encoder, AVFormatContext* format) {
  const libav::Packet packet(libav::av_packet_alloc());
  while (libav::avcodec_receive_packet(encoder, packet.get()) == 0) {
    // Without a duration the container's edit list cuts off the last frame.
    packet->duration = encoder->time_base.den == kFrame.den ? 1 : 40;
    libav::av_packet_rescale_ts(packet.get(), encoder->time_base, format->streams[0]->time_base);
    packet->stream_index = 0;
    check(libav::av_interleaved_write_frame(format, packet.get()), "cannot write");
  }
}

void turn(AVStream* stream, const VideoOptions& options) {
  constexpr std::size_t kBytes = 9 * sizeof(std::int32_t);
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)  // see libav.h
  std::uint8_t* data = libav::av_stream_new_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, kBytes);
#else
  AVCodecParameters& codec = *stream->codecpar;
  std::uint8_t* data =
      libav::av_packet_side_data_new(
          &codec.coded_side_data, &codec.nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX, kBytes, 0)
          ->data;
#endif
  auto* matrix = reinterpret_cast<std::int32_t*>(data);
  libav::av_display_rotation_set(matrix, options.clockwise_degrees);
  if (options.mirrored) libav::av_display_matrix_flip(matrix, 1, 0);
}

void add_telemetry_stream(AVFormatContext* format) {
  AVStream* stream = libav::avformat_new_stream(format, nullptr);
  stream->codecpar->codec_type = AVMEDIA_TYPE_DATA;
  stream->codecpar->codec_id = AV_CODEC_ID_BIN_DATA;
  stream->codecpar->codec_tag = MKTAG('g', 'p', 'm', 'd');
  stream->time_base = kMillisecond;
}

void write_telemetry(AVFormatContext* format, const std::vector<TelemetryPiece>& pieces) {
  for (const TelemetryPiece& piece : pieces) {
    const libav::Packet packet(libav::av_packet_alloc());
    check(libav::av_new_packet(packet.get(), static_cast<int>(piece.bytes.size())), "no memory");
    std::memcpy(packet->data, piece.bytes.data(), piece.bytes.size());
    packet->pts = packet->dts = piece.time_ms;
    packet->duration = piece.length_ms;
    packet->flags |= AV_PKT_FLAG_KEY;
    packet->stream_index = 1;
    libav::av_packet_rescale_ts(packet.get(), kMillisecond, format->streams[1]->time_base);
    check(libav::av_interleaved_write_frame(format, packet.get()), "cannot write");
  }
}

/// FFmpeg writes only one kind of telemetry; the other differs only in its name.
void rename_telemetry(const fs::path& file, const std::string& format) {
  std::ifstream stream(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(stream), {});
  for (std::size_t at = 0; (at = bytes.find("gpmd", at)) != std::string::npos; at += 4)
    bytes.replace(at, 4, format);
  std::ofstream(file, std::ios::binary) << bytes;
}

Output open_output(const fs::path& file,
                   const AVCodecContext& encoder,
                   const VideoOptions& options) {
  AVFormatContext* made = nullptr;
  check(libav::avformat_alloc_output_context2(&made, nullptr, nullptr, file.c_str()),
        "no container");
  Output format(made);
  AVStream* stream = libav::avformat_new_stream(made, nullptr);
  stream->time_base = encoder.time_base;
  stream->sample_aspect_ratio = encoder.sample_aspect_ratio;
  check(libav::avcodec_parameters_from_context(stream->codecpar, &encoder), "no parameters");
  if (options.clockwise_degrees != 0 || options.mirrored) turn(stream, options);
  if (!options.telemetry_format.empty()) add_telemetry_stream(made);
  check(libav::avio_open(&made->pb, file.c_str(), AVIO_FLAG_WRITE), "no file");
  AVDictionary* muxing = nullptr;
  for (const auto& [key, value] : options.metadata)
    libav::av_dict_set(&made->metadata, key.c_str(), value.c_str(), 0);
  if (!options.metadata.empty()) libav::av_dict_set(&muxing, "movflags", "use_metadata_tags", 0);
  check(libav::avformat_write_header(made, &muxing), "no header");
  libav::av_dict_free(&muxing);
  return format;
}

template <class Number>
std::string little_endian(Number number) {
  std::string bytes(sizeof(number), '\0');
  std::memcpy(bytes.data(), &number, sizeof(number));
  return bytes;
}

}  // namespace

void make_video(const fs::path& file,
                const std::vector<cv::Mat>& images,
                const VideoOptions& options) {
  libav::av_log_set_level(AV_LOG_QUIET);
  const auto& times_ms = options.times_ms;
  const auto encoder = open_encoder(images[0], file, options);
  Output format = open_output(file, *encoder, options);
  for (int i = 0; i < static_cast<int>(images.size()); ++i) {
    const auto frame = frame_of(images[i], *encoder, times_ms.empty() ? i : times_ms[i]);
    if (options.top_field_first) declare_fields(*frame, *options.top_field_first);
    check(libav::avcodec_send_frame(encoder.get(), frame.get()), "no frame");
    drain(encoder.get(), format.get());
  }
  libav::avcodec_send_frame(encoder.get(), nullptr);
  drain(encoder.get(), format.get());
  if (!options.telemetry_format.empty()) write_telemetry(format.get(), options.telemetry);
  libav::av_write_trailer(format.get());
  format.reset();
  if (options.telemetry_format == "camm") rename_telemetry(file, options.telemetry_format);
}

std::string gpmf_item(const std::string& key, char type, int size, const std::string& data) {
  const auto count = static_cast<std::int64_t>(data.size()) / size;
  std::string item = key + type + static_cast<char>(size) + big_endian({count}, 2) + data;
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
  return std::string("\0\0\2\0", 4) + little_endian(x) + little_endian(y) + little_endian(z);
}

std::string camm_exposure(std::int32_t exposure_ns, std::int32_t skew_ns) {
  return std::string("\0\0\1\0", 4) + little_endian(exposure_ns) + little_endian(skew_ns);
}

}  // namespace gpo::test
