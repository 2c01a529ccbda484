// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

/// FFmpeg's objects, freed by its own functions.
namespace gpo::libav {

template <auto close>
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

}  // namespace gpo::libav
