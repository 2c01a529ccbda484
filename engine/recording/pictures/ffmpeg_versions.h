// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

// Where the versions of FFmpeg that the program is built with differ, 5.1 (Debian 12) to 7.1
// (Debian 13).
namespace gpo::libav {

/// What a container says about how to turn a stream's pictures, for av_display_rotation_get; null
/// where it says nothing.
inline const std::int32_t* display_matrix(const AVStream& stream) {
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)
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
