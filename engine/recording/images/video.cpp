// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"
#include "engine/recording/images/libav.h"

#include <algorithm>
#include <cmath>

namespace gpo {
namespace {

constexpr std::int64_t kMostPixels = 100'000'000;
constexpr const char* kContainers = "mov,avi,matroska,mpegts,mpeg,flv,asf,ogg";
constexpr int kStepsWorthDecoding = 8;  // rather than seeking to a key frame in between

void close_output(AVFormatContext** format) {
  libav::avio_closep(&(*format)->pb);
  libav::avformat_free_context(*format);
}

constexpr int kQuality = 3;           ///< 1 (best) to 31: no visible blocks in uniform areas
constexpr int kLargestRate = 65'535;  ///< numerator of the rate, limited by MPEG-4

[[noreturn]] void fail_to_open(const fs::path& file) {
  refuse(file, "cannot decode: truncated, or not a video");
}

int quarter_turns(const AVStream& stream) {
  const std::int32_t* matrix = libav::display_matrix(stream);
  if (matrix == nullptr) return 0;
  const double turns = -libav::av_display_rotation_get(matrix) / 90;
  return std::isfinite(turns) ? ((static_cast<int>(std::lround(turns)) % 4) + 4) % 4 : 0;
}

/// Returns whether the container declares clearly more frames than it has, over a longer time.
bool is_truncated(const VideoIndex& index) {
  const double missing = index.declared_count - static_cast<double>(index.times.size());
  if (missing <= std::max(2.0, index.declared_count / 100)) return false;
  if (index.times.empty() || index.rate_hz <= 0) return true;
  const double duration_s =
      static_cast<double>(index.times.back() - index.times.front()) * index.unit_s;
  return index.declared_count - (duration_s * index.rate_hz + 1) > missing / 2;
}

std::vector<std::int64_t> timestamps_ns(const VideoIndex& index) {
  std::vector<std::int64_t> times;
  for (const std::int64_t time : index.times)
    times.push_back(
        std::llround(static_cast<double>(time - index.times.front()) * index.unit_s * 1e9));
  return times;
}

}  // namespace

struct VideoDecoder::Input {
  libav::Format format;
  AVStream* stream = nullptr;
  libav::Codec codec;
  libav::Packet packet{libav::av_packet_alloc()};
  libav::Frame frame{libav::av_frame_alloc()};
  libav::Scaler scaler;

  explicit Input(const fs::path& file) : format(libav::open_input(file, kContainers)) {
    if (!format || libav::avformat_find_stream_info(format.get(), nullptr) < 0) fail_to_open(file);
    const AVCodec* decoder = nullptr;
    const int best =
        libav::av_find_best_stream(format.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &decoder, 0);
    if (best < 0 || decoder == nullptr) fail_to_open(file);
    stream = format->streams[best];
    for (unsigned i = 0; i < format->nb_streams; ++i)
      if (format->streams[i] != stream) format->streams[i]->discard = AVDISCARD_ALL;
    codec.reset(libav::avcodec_alloc_context3(decoder));
    codec->thread_count = 0;
    codec->max_pixels = kMostPixels;
    if (libav::avcodec_parameters_to_context(codec.get(), stream->codecpar) < 0 ||
        libav::avcodec_open2(codec.get(), decoder, nullptr) < 0)
      fail_to_open(file);
  }

  bool read_packet() {
    for (;;) {
      libav::av_packet_unref(packet.get());
      if (libav::av_read_frame(format.get(), packet.get()) < 0) return false;
      if (packet->stream_index == stream->index) return true;
    }
  }

  bool decode_frame() {
    for (;;) {
      const int received = libav::avcodec_receive_frame(codec.get(), frame.get());
      if (received == 0) return true;
      if (received != AVERROR(EAGAIN)) return false;
      // Skips broken packets, as players do.
      libav::avcodec_send_packet(codec.get(), read_packet() ? packet.get() : nullptr);
    }
  }

  bool seek(std::int64_t time) {
    if (libav::av_seek_frame(format.get(), stream->index, time, AVSEEK_FLAG_BACKWARD) < 0)
      return false;
    libav::avcodec_flush_buffers(codec.get());
    return true;
  }

  cv::Mat image(const fs::path& file) {
    const AVFrame& from = *frame;
    libav::set_scaler(scaler, from.width, from.height, from.format, AV_PIX_FMT_BGR24);
    if (!scaler) fail_to_open(file);
    cv::Mat bgr(from.height, from.width, CV_8UC3);
    std::uint8_t* const planes[] = {bgr.data};
    const int strides[] = {static_cast<int>(bgr.step)};
    libav::sws_scale(scaler.get(), from.data, from.linesize, 0, from.height, planes, strides);
    const int turns = quarter_turns(*stream);
    if (turns > 0) cv::rotate(bgr, bgr, turns - 1);
    return bgr;
  }
};

namespace {

struct PacketTimes {
  std::vector<std::int64_t> all;
  std::vector<std::int64_t> keys;
  bool exact = true;  ///< all known and different

  void add(const AVPacket& packet, bool reordered) {
    if ((packet.flags & (AV_PKT_FLAG_DISCARD | AV_PKT_FLAG_CORRUPT)) != 0) return;
    const bool timed = packet.pts != AV_NOPTS_VALUE;
    exact = exact && (timed || (!reordered && packet.dts != AV_NOPTS_VALUE));
    const std::int64_t time = timed ? packet.pts : packet.dts;
    all.push_back(time);
    if ((packet.flags & AV_PKT_FLAG_KEY) != 0) keys.push_back(time);
  }
  void finish() {
    std::ranges::sort(all);
    std::ranges::sort(keys);
    exact = exact && std::ranges::adjacent_find(all) == all.end();
  }
};

double declared_count(const AVFormatContext& format, const AVStream& stream) {
  if (stream.nb_frames > 0) return static_cast<double>(stream.nb_frames);
  const double rate = av_q2d(stream.avg_frame_rate);
  return format.duration > 0 && rate > 0
             ? static_cast<double>(format.duration) / AV_TIME_BASE * rate
             : 0;
}

}  // namespace

VideoDecoder::VideoDecoder(fs::path file, const ReadProgress& progress)
    : file_(std::move(file)), input_(std::make_unique<Input>(file_)) {
  const AVStream& stream = *input_->stream;
  const AVCodecParameters& parameters = *stream.codecpar;
  index_.unit_s = av_q2d(stream.time_base);
  index_.size = {parameters.width, parameters.height};
  index_.quarter_turns = quarter_turns(stream);
  if (index_.quarter_turns % 2 == 1) std::swap(index_.size.width, index_.size.height);
  const double rate = av_q2d(stream.avg_frame_rate);
  if (std::isfinite(rate)) index_.rate_hz = rate;
  index_.declared_count = declared_count(*input_->format, stream);
  PacketTimes times;
  const double bytes = 1 + static_cast<double>(libav::avio_size(input_->format->pb));
  while (input_->read_packet()) {
    times.add(*input_->packet, parameters.video_delay > 0);
    if (progress)
      progress(static_cast<double>(libav::avio_seek(input_->format->pb, 0, SEEK_CUR)) / bytes);
  }
  times.finish();
  index_.times = std::move(times.all);
  index_.key_times = std::move(times.keys);
  restart();
  if (times.exact) return;
  numbering_ = Numbering::by_count;
  index_.times.clear();
  const double period = 1 / (index_.unit_s * (index_.rate_hz > 0 ? index_.rate_hz : 30.0));
  for (int frame = next_frame(); frame >= 0; frame = next_frame()) {
    index_.times.push_back(std::llround(frame * period));
    if (progress)
      progress(static_cast<double>(libav::avio_seek(input_->format->pb, 0, SEEK_CUR)) / bytes);
  }
  restart();
}

VideoDecoder::~VideoDecoder() = default;

void VideoDecoder::restart() {
  input_.reset();
  state_ = State::begin;
}

/// Decodes the next frame. Returns its number, or -1 at the end.
int VideoDecoder::next_frame() {
  if (!input_) input_ = std::make_unique<Input>(file_);
  while (input_->decode_frame()) {
    if (numbering_ == Numbering::by_count) {
      last_ = state_ == State::begin ? 0 : last_ + 1;
    } else {
      const auto& times = index_.times;
      const auto at = std::ranges::lower_bound(times, input_->frame->best_effort_timestamp);
      if (at == times.end() || *at != input_->frame->best_effort_timestamp) continue;
      last_ = static_cast<int>(at - times.begin());
    }
    state_ = State::decoding;
    return last_;
  }
  return -1;
}

/// Seeks so that decoding leads to the frame. Returns the first frame that is complete from there
/// on: frames between a key frame and those shown before it may lack their references.
int VideoDecoder::go_to(int frame) {
  const auto& keys = index_.key_times;
  const std::int64_t time = index_.times[frame];
  const bool timed = numbering_ == Numbering::by_time;
  auto key = std::ranges::upper_bound(keys, time);
  if (key != keys.begin()) --key;
  if (state_ == State::decoding && frame > last_) {
    const bool key_between = timed && key != keys.end() && *key > index_.times[last_];
    if (!key_between || frame - last_ <= kStepsWorthDecoding) return last_ + 1;
  }
  kept_.clear();
  const bool seekable = timed && key != keys.end() && *key <= time;
  if (seekable && input_ && input_->seek(*key))
    state_ = State::seeking;
  else
    restart();
  if (!seekable) return 0;
  return static_cast<int>(std::ranges::lower_bound(index_.times, *key) - index_.times.begin());
}

cv::Mat VideoDecoder::decode(int frame) {
  if (const auto kept = kept_.find(frame); kept != kept_.end()) return kept->second;
  const bool backward = state_ == State::decoding && last_ > frame;
  const int whole = go_to(frame);
  const int first_kept = backward ? std::max(whole, frame - kKept) : frame;
  while (true) {
    const bool seeking = state_ == State::seeking;
    const int decoded = next_frame();
    if (seeking && decoded > frame) {
      restart();  // the seek went too far
      continue;
    }
    if (decoded < 0 || decoded > frame) {
      restart();
      refuse(file_, "frame {} cannot be decoded", frame);
    }
    if (decoded < first_kept) continue;
    cv::Mat image = input_->image(file_);
    if (decoded == frame) return image;
    kept_[decoded] = std::move(image);
  }
}

VideoFile open_video(const fs::path& file,
                     Camera& camera,
                     std::size_t cache_bytes,
                     const ReadProgress& progress) {
  if (!is_file(file)) refuse(file, "no such file");
  const auto decoder = std::make_shared<VideoDecoder>(file, progress);
  const VideoIndex& index = decoder->index();
  if (index.times.empty() || is_truncated(index))
    refuse(file,
           "found {} frames (the file seems truncated), expected {}",
           index.times.size(),
           std::max(1L, std::lround(index.declared_count)));
  check_size(file, index.size, camera);
  if (index.quarter_turns != 0 && !camera.readout_direction)
    camera.readout_direction = static_cast<ReadoutDirection>(index.quarter_turns);
  camera.width = index.size.width;
  camera.height = index.size.height;
  const auto one_at_a_time = std::make_shared<std::mutex>();
  const auto decode = [decoder, one_at_a_time, file, camera](int frame) {
    cv::Mat image;
    {
      const std::scoped_lock lock(*one_at_a_time);
      image = decoder->decode(frame);
    }
    check_size(file, image.size(), camera);
    return image;
  };
  // The decoder's frames count towards the limit.
  const std::size_t kept = VideoDecoder::kKept * std::size_t{3} * index.size.area();
  const std::size_t left = cache_bytes - std::min(kept, cache_bytes / 2);
  const int count = static_cast<int>(index.times.size());
  return {.timestamps_ns = timestamps_ns(index),
          .images = std::make_shared<const FrameCache>(count, decode, left),
          .first_frame_s = static_cast<double>(index.times.front()) * index.unit_s,
          .quarter_turns = index.quarter_turns};
}

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
  std::array<char, AV_ERROR_MAX_STRING_SIZE> why{};
  libav::av_strerror(error, why.data(), why.size());
  refuse(file_, "cannot be written: {}", why.data());
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
