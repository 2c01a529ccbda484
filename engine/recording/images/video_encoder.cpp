// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/recording/images/images.h"
#include "engine/recording/images/libav.h"

namespace gpo {
namespace {

void close_output(AVFormatContext** format) {
  libav::avio_closep(&(*format)->pb);
  libav::avformat_free_context(*format);
}

constexpr int kQuality = 3;           ///< 1 (best) to 31: no visible blocks in uniform areas
constexpr int kLargestRate = 65'535;  ///< numerator of the rate, limited by MPEG-4

}  // namespace

struct VideoEncoder::Output {
  std::unique_ptr<AVFormatContext, libav::Closer<close_output>> format;
  libav::Codec codec;
  libav::Packet packet{libav::av_packet_alloc()};
  libav::Frame frame{libav::av_frame_alloc()};
  libav::Scaler scaler;
};

VideoEncoder::VideoEncoder(fs::path file, double rate_hz, cv::Size size)
    : file_(std::move(file)), unfinished_(file_), size_(size), output_(std::make_unique<Output>()) {
  const AVCodec* encoder = libav::avcodec_find_encoder(AV_CODEC_ID_MPEG4);
  if (encoder == nullptr) refuse(file_, "cannot be written: FFmpeg has no MPEG-4 encoder");
  auto& [format, codec, packet, frame, scaler] = *output_;
  const std::string path = unfinished_.path().string();
  AVFormatContext* made = nullptr;
  check(libav::avformat_alloc_output_context2(&made, nullptr, "mp4", path.c_str()));
  format.reset(made);

  codec.reset(libav::avcodec_alloc_context3(encoder));
  codec->width = frame->width = size_.width;
  codec->height = frame->height = size_.height;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  frame->format = AV_PIX_FMT_YUV420P;
  codec->time_base = av_inv_q(libav::av_d2q(rate_hz, kLargestRate));
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_QSCALE;
  codec->global_quality = FF_QP2LAMBDA * kQuality;
  check(libav::avcodec_open2(codec.get(), encoder, nullptr));
  check(libav::av_frame_get_buffer(frame.get(), 0));
  libav::set_scaler(scaler, size_.width, size_.height, AV_PIX_FMT_BGR24, AV_PIX_FMT_YUV420P);

  AVStream* stream = libav::avformat_new_stream(made, nullptr);
  stream->time_base = codec->time_base;
  stream->avg_frame_rate = av_inv_q(codec->time_base);
  check(libav::avcodec_parameters_from_context(stream->codecpar, codec.get()));
  check(libav::avio_open(&made->pb, ("file:" + path).c_str(), AVIO_FLAG_WRITE));
  check(libav::avformat_write_header(made, nullptr));
}

VideoEncoder::~VideoEncoder() = default;

void VideoEncoder::check(int result) const {
  // A full disk shows only in the file's state while the muxer buffers.
  const AVIOContext* stream = output_->format ? output_->format->pb : nullptr;
  const int error = result >= 0 && stream != nullptr ? stream->error : result;
  if (error >= 0) return;
  refuse(file_, "cannot be written: {}", libav::text_of_error(error));
}

void VideoEncoder::drain() {
  auto& [format, codec, packet, frame, scaler] = *output_;
  const AVStream& stream = *format->streams[0];
  while (libav::avcodec_receive_packet(codec.get(), packet.get()) == 0) {
    packet->duration = 1;  // otherwise the last frame is lost
    libav::av_packet_rescale_ts(packet.get(), codec->time_base, stream.time_base);
    check(libav::av_write_frame(format.get(), packet.get()));
  }
}

void VideoEncoder::add(const cv::Mat& image) {
  if (image.size() != size_) refuse(file_, "the image's size changed");
  auto& [format, codec, packet, frame, scaler] = *output_;
  check(libav::av_frame_make_writable(frame.get()));
  const std::array<const std::uint8_t*, 1> rows{image.data};
  const std::array<int, 1> stride{static_cast<int>(image.step)};
  libav::sws_scale(
      scaler.get(), rows.data(), stride.data(), 0, size_.height, frame->data, frame->linesize);
  frame->quality = codec->global_quality;
  frame->pts = count_++;
  check(libav::avcodec_send_frame(codec.get(), frame.get()));
  drain();
}

void VideoEncoder::finish() {
  if (count_ == 0) refuse(file_, "not written: there are no images");
  check(libav::avcodec_send_frame(output_->codec.get(), nullptr));
  drain();
  check(libav::av_write_trailer(output_->format.get()));
  libav::avio_flush(output_->format->pb);
  check(0);
  output_.reset();
  unfinished_.finish();
}

cv::Size even_size(cv::Size size) {
  return {size.width + size.width % 2, size.height + size.height % 2};
}

}  // namespace gpo
