// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Cameras by libavdevice and streams by libavformat.
#include "engine/files/refuse.h"
#include "engine/recording/images/images.h"
#include "engine/recording/images/libav.h"
#include "engine/recording/live/sources.h"

#include <algorithm>
#include <cerrno>
#include <regex>
#include <string_view>

#include <fcntl.h>
#include <unistd.h>

namespace gpo {
namespace {

constexpr std::int64_t kPoll_ns = 2'000'000;  // between two reads of a camera, which do not block

/// Keys and values.
using Options = std::vector<std::pair<const char*, std::string>>;

/// An input of libavformat, decoded image by image.
class LiveInput {
 public:
  LiveInput(std::string address, const SourceContext& context)
      : address_(std::move(address)), context_(context) {}

  void open(const char* url, const AVInputFormat* format, int flags, const Options& options) {
    libav::limit_memory();
    AVFormatContext* opened = libav::avformat_alloc_context();
    opened->flags |= flags;
    opened->interrupt_callback = {
        [](void* self) { return static_cast<LiveInput*>(self)->is_interrupted() ? 1 : 0; }, this};
    AVDictionary* entries = nullptr;
    for (const auto& [key, value] : options) libav::av_dict_set(&entries, key, value.c_str(), 0);
    const int error =
        libav::avformat_open_input(&opened, url, const_cast<AVInputFormat*>(format), &entries);
    libav::av_dict_free(&entries);
    if (error < 0) fail(error);
    format_.reset(opened);
  }

  /// Reads the stream's parameters if the container does not declare them.
  void find_video(bool is_declared) {
    if (!is_declared) {
      format_->max_analyze_duration = AV_TIME_BASE / 2;  // the first image waits for it
      format_->fps_probe_size = 1;                       // the rate is not used
      if (const int error = libav::avformat_find_stream_info(format_.get(), nullptr); error < 0)
        fail(error);
    }
    codec_ = libav::open_decoder(*format_, 1, stream_);  // several threads delay the images
    if (stream_ == nullptr) refuse_source("has no video that can be decoded");
    if (!codec_) refuse_source("has a video that cannot be decoded");
    // Raw JPEG has no times; libavformat invents 25 frames per second.
    const std::string_view name = format_->iformat->name;
    has_times_ = name.find("jpeg") == std::string_view::npos;
  }

  std::optional<TimedImage> read() {
    for (;;) {
      const int received = libav::avcodec_receive_frame(codec_.get(), frame_.get());
      if (received == 0) {
        if (auto image = image_of_frame()) return image;
        continue;
      }
      if (received == AVERROR_EOF) return std::nullopt;
      // Images before the first key frame, for one, cannot be decoded.
      if (received != AVERROR(EAGAIN)) ++broken_;
      if (!send_packet()) return std::nullopt;
    }
  }

  int broken() const { return broken_; }

 private:
  bool is_interrupted() const { return context_.interrupted(); }

  [[noreturn]] void refuse_source(std::string_view why) const { refuse(address_, "{}", why); }

  [[noreturn]] void fail(int error) const {
    check_stop();
    if (error == AVERROR_EXIT) refuse_source("no data; check the sender and the address");
    if (address_.starts_with("camera:")) throw InputError(camera_error(address_, AVUNERROR(error)));
    // libavformat reports unknown content as any of these.
    if (error == AVERROR_INVALIDDATA || error == AVERROR(EIO) || error == AVERROR(EINVAL))
      refuse_source("sends no video in MPEG-TS, MJPEG or RTSP; check the sender and the address");
    refuse_source(libav::text_of_error(error) + "; check the sender and the address");
  }

  /// Sends the next packet of the video to the decoder, at the end an empty one. Returns false if
  /// interrupted or after the end.
  bool send_packet() {
    if (is_at_end_) return false;
    for (;;) {
      libav::av_packet_unref(packet_.get());
      const int error = libav::av_read_frame(format_.get(), packet_.get());
      if (is_interrupted()) return false;
      if (error == AVERROR(EAGAIN)) {
        context_.clock.wait_until(context_.clock.now_ns() + kPoll_ns, context_.stop);
        continue;
      }
      if (error == AVERROR(ENODEV)) refuse_source("was unplugged");
      is_at_end_ = error < 0;
      if (!is_at_end_ && packet_->stream_index != stream_->index) continue;
      if (!is_at_end_ && is_cut_jpeg()) {
        ++broken_;
        continue;
      }
      const AVPacket* const sent = is_at_end_ ? nullptr : packet_.get();
      if (libav::avcodec_send_packet(codec_.get(), sent) < 0 && !is_at_end_) ++broken_;
      return true;
    }
  }

  /// The decoder would fill up a truncated JPEG without a report.
  bool is_cut_jpeg() const {
    const char* bytes = reinterpret_cast<const char*>(packet_->data);
    return !has_times_ && !is_whole_jpeg({bytes, static_cast<std::size_t>(packet_->size)});
  }

  std::optional<TimedImage> image_of_frame() {
    const std::int64_t arrival_ns = context_.clock.now_ns();
    if (libav::is_damaged(*frame_)) {
      ++broken_;
      return std::nullopt;
    }
    cv::Mat bgr = convert_(*frame_);
    if (bgr.empty()) refuse_source("has pixels of an unknown format");
    std::optional<std::int64_t> sender_ns;
    if (has_times_ && frame_->best_effort_timestamp != AV_NOPTS_VALUE)
      sender_ns = std::llround(static_cast<double>(frame_->best_effort_timestamp) *
                               av_q2d(stream_->time_base) * 1e9);
    return TimedImage{bgr, times_.next(arrival_ns, sender_ns)};
  }

  const std::string address_;
  const SourceContext context_;
  libav::Format format_;
  AVStream* stream_ = nullptr;
  libav::Codec codec_;
  libav::Packet packet_{libav::av_packet_alloc()};
  libav::Frame frame_{libav::av_frame_alloc()};
  libav::BgrConverter convert_;
  CaptureTimes times_;
  bool has_times_ = true;
  bool is_at_end_ = false;
  int broken_ = 0;
};

OpenSource source_of(const std::shared_ptr<LiveInput>& input, const std::string& device) {
  return {.device = device,
          .read = [input] { return input->read(); },
          .broken = [input] { return input->broken(); }};
}

struct CameraChoice {
  int number;
  std::string size, rate_hz;  ///< empty: the camera's default
};

CameraChoice camera_choice(const std::string& address) {
  static const std::regex form(R"(camera:(\d{1,2})(?:,(\d{1,5}x\d{1,5})(?:,(\d{1,3}))?)?)");
  std::smatch parts;
  if (!std::regex_match(address, parts, form))
    refuse(address, "expected camera:0, camera:0,640x480 or camera:0,640x480,30");
  return {std::stoi(parts[1]), parts[2], parts[3]};
}

/// Throws InputError unless a UDP address has a port: FFmpeg would wait for data without an end.
void check_udp_port(const std::string& address) {
  static const std::regex kWithPort(R"(udp://[^/?]*:(\d{1,5})([/?].*)?)");
  std::smatch parts;
  constexpr int kMostPort = 65'535;
  const bool found = std::regex_match(address, parts, kWithPort);
  const int port = found ? std::stoi(parts[1]) : 0;
  if (port < 1 || port > kMostPort)
    refuse(address, "expected udp://HOST:PORT with a port from 1 to {}", kMostPort);
}

}  // namespace

OpenSource open_camera(const SourceAddress& address, const SourceContext& context) {
  const CameraChoice choice = camera_choice(address.text);
  const std::string file = fmt::format("/dev/video{}", choice.number);
  // libavdevice reports only that it cannot open the file.
  const int opened = ::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (opened < 0) throw InputError(camera_error(address.text, errno));
  ::close(opened);
  libav::avdevice_register_all();
  const AVInputFormat* format = libav::av_find_input_format("video4linux2");
  if (format == nullptr) refuse(address.text, "FFmpeg's libavdevice has no V4L2");
  const auto input = std::make_shared<LiveInput>(address.text, context);
  Options options;
  if (!choice.size.empty()) options.emplace_back("video_size", choice.size);
  if (!choice.rate_hz.empty()) options.emplace_back("framerate", choice.rate_hz);
  input->open(file.c_str(), format, AVFMT_FLAG_NONBLOCK, options);
  input->find_video(true);
  const auto cameras = list_cameras();
  const auto listed = std::ranges::find(cameras, choice.number, &CameraDevice::number);
  return source_of(input, "camera:" + (listed == cameras.end() ? file : listed->name));
}

OpenSource open_stream(const SourceAddress& address, const SourceContext& context) {
  const SourceRow& row = source_row(address.text);
  if (row.prefix == "udp://") check_udp_port(address.text);
  Options options = {{"format_whitelist", row.formats}, {"protocol_whitelist", row.protocols}};
  if (row.prefix == "udp://") options.emplace_back("overrun_nonfatal", "1");
  if (row.prefix == "rtsp://") options.emplace_back("allowed_media_types", "video");
  const auto input = std::make_shared<LiveInput>(address.text, context);
  input->open(address.text.c_str(), nullptr, 0, options);
  input->find_video(false);
  return source_of(input, address.text);
}

}  // namespace gpo
