// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/stop.h"
#include "engine/files/budget.h"
#include "engine/files/libav_functions.h"
#include "engine/files/paths.h"

#include <algorithm>
#include <array>
#include <climits>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include <opencv2/core.hpp>

/// FFmpeg's objects, freed by its own functions.
namespace gpo::libav {

template <const auto& close>
struct Closer {
  template <class T>
  void operator()(T* object) const {
    close(&object);
  }
};
struct ScalerCloser {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

using Codec = std::unique_ptr<AVCodecContext, Closer<avcodec_free_context>>;
using Packet = std::unique_ptr<AVPacket, Closer<av_packet_free>>;
using Frame = std::unique_ptr<AVFrame, Closer<av_frame_free>>;
using Scaler = std::unique_ptr<SwsContext, ScalerCloser>;
using Format = std::unique_ptr<AVFormatContext, Closer<avformat_close_input>>;

/// Makes `scaler` convert images of this size between pixel formats.
inline void set_scaler(Scaler& scaler, int width, int height, int from_format, int to_format) {
  const auto from = static_cast<AVPixelFormat>(from_format);
  const auto to = static_cast<AVPixelFormat>(to_format);
  // Bicubic, the same as OpenCV's reader.
  scaler.reset(sws_getCachedContext(scaler.release(),
                                    width,
                                    height,
                                    from,
                                    width,
                                    height,
                                    to,
                                    SWS_BICUBIC,
                                    nullptr,
                                    nullptr,
                                    nullptr));
}

/// Converts decoded frames to CV_8UC3, BGR.
class BgrConverter {
 public:
  /// Returns an empty image if the pixel format is not supported.
  cv::Mat operator()(const AVFrame& from) {
    set_scaler(scaler_, from.width, from.height, from.format, AV_PIX_FMT_BGR24);
    if (!scaler_) return {};
    if (from.color_range == AVCOL_RANGE_JPEG) use_full_range();
    cv::Mat bgr(from.height, from.width, CV_8UC3);
    std::uint8_t* const planes[] = {bgr.data};
    const int strides[] = {static_cast<int>(bgr.step)};
    sws_scale(scaler_.get(), from.data, from.linesize, 0, from.height, planes, strides);
    return bgr;
  }

 private:
  /// The scaler knows the range only of the pixel formats for JPEG; others would be clipped.
  void use_full_range() {
    if (full_range_ == scaler_.get()) return;
    const int* table = sws_getCoefficients(SWS_CS_DEFAULT);
    constexpr int kNoChange = 1 << 16;
    sws_setColorspaceDetails(scaler_.get(), table, 1, table, 1, 0, kNoChange, kNoChange);
    full_range_ = scaler_.get();
  }

  Scaler scaler_;
  SwsContext* full_range_ = nullptr;  ///< the scaler, if set to the full range
};

/// Limits the blocks that FFmpeg allocates, as a container may claim any number of frames.
inline void limit_memory() {
  const std::uint64_t most = 3 * limits().video_pixels;
  av_max_alloc(static_cast<std::size_t>(std::min<std::uint64_t>(most, INT_MAX)));
}
/// Formats of libavformat that may be opened. image2 is none of them: it reads further files.
inline constexpr const char* kVideoContainers = "mov,avi,matroska,mpegts,mpeg,flv,asf,ogg";

/// Null unless it is one of these containers: playlists could open further files and URLs. A stop
/// ends its reading with an error.
inline Format open_input(const fs::path& file, const char* containers) {
  limit_memory();
  AVFormatContext* opened = avformat_alloc_context();
  opened->interrupt_callback.callback = [](void* /*none*/) -> int {
    return current_stop().stop_requested() ? 1 : 0;
  };
  AVDictionary* options = nullptr;
  av_dict_set(&options, "format_whitelist", containers, 0);
  // Without the protocol a path with a colon would be taken for a URL.
  const std::string address = "file:" + file.string();
  const int error = avformat_open_input(&opened, address.c_str(), nullptr, &options);
  av_dict_free(&options);
  check_stop();
  return Format(error < 0 ? nullptr : opened);
}

/// Opens a decoder of the best video; null if that fails. Sets `stream`, to null if there is none
/// that can be decoded. `threads`: 0 for all processors.
inline Codec open_decoder(AVFormatContext& format, int threads, AVStream*& stream) {
  const AVCodec* decoder = nullptr;
  const int best = av_find_best_stream(&format, AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
  stream = best < 0 || decoder == nullptr ? nullptr : format.streams[best];
  if (stream == nullptr) return nullptr;
  Codec codec(avcodec_alloc_context3(decoder));
  codec->thread_count = threads;
  codec->max_pixels = static_cast<std::int64_t>(limits().video_pixels);
  const bool opened = avcodec_parameters_to_context(codec.get(), stream->codecpar) >= 0 &&
                      avcodec_open2(codec.get(), decoder, nullptr) >= 0;
  return opened ? std::move(codec) : nullptr;
}

/// Reads the next packet of a stream. Returns false at the end. Throws Stopped.
inline bool read_packet(AVFormatContext& format, const AVStream& stream, AVPacket& packet) {
  for (;;) {
    av_packet_unref(&packet);
    check_stop();
    if (av_read_frame(&format, &packet) < 0) {
      check_stop();
      return false;
    }
    if (packet.stream_index == stream.index) return true;
  }
}

inline bool is_damaged(const AVFrame& frame) {
  return (frame.flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame.decode_error_flags != 0;
}

inline std::string text_of_error(int error) {
  std::array<char, AV_ERROR_MAX_STRING_SIZE> why{};
  av_strerror(error, why.data(), why.size());
  return why.data();
}

/// Returns the container's rotation of a stream's images, for av_display_rotation_get; null if
/// there is none.
inline const std::int32_t* display_matrix(const AVStream& stream) {
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)  // see libav_functions.h
  const std::uint8_t* data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr);
#else
  const AVCodecParameters& codec = *stream.codecpar;
  const AVPacketSideData* found = av_packet_side_data_get(
      codec.coded_side_data, codec.nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX);
  const std::uint8_t* data = found == nullptr ? nullptr : found->data;
#endif
  return reinterpret_cast<const std::int32_t*>(data);
}

}  // namespace gpo::libav
