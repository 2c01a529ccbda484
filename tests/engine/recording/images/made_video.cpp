// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/recording/images/made_video.h"

#include <stdexcept>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
}
#include <opencv2/imgproc.hpp>

namespace gpo::test {
namespace {

constexpr AVRational kMillisecond = {1, 1000};
constexpr AVRational kFrame = {1, 25};

void check(int result, const char* what) {
  if (result < 0) throw std::runtime_error(what);
}

AVCodecContext* open_encoder(const cv::Mat& image, bool b_frames, AVRational time_base) {
  const AVCodec* codec = avcodec_find_encoder(b_frames ? AV_CODEC_ID_MPEG4 : AV_CODEC_ID_MJPEG);
  AVCodecContext* encoder = avcodec_alloc_context3(codec);
  encoder->width = image.cols;
  encoder->height = image.rows;
  encoder->pix_fmt = b_frames ? AV_PIX_FMT_YUV420P : AV_PIX_FMT_YUVJ420P;
  encoder->time_base = time_base;
  encoder->bit_rate = 4'000'000;
  encoder->gop_size = b_frames ? 12 : 1;
  encoder->max_b_frames = b_frames ? 2 : 0;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  check(avcodec_open2(encoder, codec, nullptr), "no encoder");
  return encoder;
}

AVFrame* frame_of(const cv::Mat& image, const AVCodecContext& encoder, std::int64_t time) {
  cv::Mat yuv;
  cv::cvtColor(image, yuv, cv::COLOR_BGR2YUV_I420);
  AVFrame* frame = av_frame_alloc();
  frame->width = encoder.width;
  frame->height = encoder.height;
  frame->format = encoder.pix_fmt;
  check(av_frame_get_buffer(frame, 0), "no memory");
  const std::uint8_t* from = yuv.data;
  for (int plane = 0; plane < 3; ++plane) {
    const int half = plane == 0 ? 1 : 2;
    for (int row = 0; row < image.rows / half; ++row, from += image.cols / half)
      std::copy_n(from, image.cols / half, frame->data[plane] + row * frame->linesize[plane]);
  }
  frame->pts = time;
  return frame;
}

void drain(AVCodecContext* encoder, AVFormatContext* format) {
  AVPacket* packet = av_packet_alloc();
  AVStream* stream = format->streams[0];
  while (avcodec_receive_packet(encoder, packet) == 0) {
    // Without it the last frame would be cut off by the container's edit list.
    packet->duration = encoder->time_base.den == kFrame.den ? 1 : 40;
    av_packet_rescale_ts(packet, encoder->time_base, stream->time_base);
    packet->stream_index = 0;
    check(av_interleaved_write_frame(format, packet), "cannot write");
  }
  av_packet_free(&packet);
}

void turn(AVStream* stream, int clockwise_degrees) {
  constexpr std::size_t kBytes = 9 * sizeof(std::int32_t);
#if LIBAVFORMAT_VERSION_INT < AV_VERSION_INT(60, 15, 100)  // see ffmpeg_versions.h
  std::uint8_t* data = av_stream_new_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, kBytes);
#else
  AVCodecParameters& codec = *stream->codecpar;
  std::uint8_t* data =
      av_packet_side_data_new(
          &codec.coded_side_data, &codec.nb_coded_side_data, AV_PKT_DATA_DISPLAYMATRIX, kBytes, 0)
          ->data;
#endif
  av_display_rotation_set(reinterpret_cast<std::int32_t*>(data), clockwise_degrees);
}

}  // namespace

void make_video(const std::filesystem::path& file,
                const std::vector<cv::Mat>& images,
                const VideoOptions& options) {
  av_log_set_level(AV_LOG_QUIET);
  AVFormatContext* format = nullptr;
  check(avformat_alloc_output_context2(&format, nullptr, nullptr, file.c_str()), "no container");
  AVCodecContext* encoder =
      open_encoder(images[0], options.b_frames, options.times_ms.empty() ? kFrame : kMillisecond);
  AVStream* stream = avformat_new_stream(format, nullptr);
  stream->time_base = encoder->time_base;
  check(avcodec_parameters_from_context(stream->codecpar, encoder), "no parameters");
  if (options.clockwise_degrees != 0) turn(stream, options.clockwise_degrees);
  check(avio_open(&format->pb, file.c_str(), AVIO_FLAG_WRITE), "no file");
  AVDictionary* muxing = nullptr;
  for (const auto& [key, value] : options.metadata)
    av_dict_set(&format->metadata, key.c_str(), value.c_str(), 0);
  if (!options.metadata.empty()) av_dict_set(&muxing, "movflags", "use_metadata_tags", 0);
  check(avformat_write_header(format, &muxing), "no header");
  av_dict_free(&muxing);
  for (int i = 0; i < static_cast<int>(images.size()); ++i) {
    AVFrame* frame =
        frame_of(images[i], *encoder, options.times_ms.empty() ? i : options.times_ms[i]);
    check(avcodec_send_frame(encoder, frame), "no frame");
    av_frame_free(&frame);
    drain(encoder, format);
  }
  avcodec_send_frame(encoder, nullptr);
  drain(encoder, format);
  av_write_trailer(format);
  avio_closep(&format->pb);
  avcodec_free_context(&encoder);
  avformat_free_context(format);
}

}  // namespace gpo::test
