// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/stop.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/images/images.h"
#include "engine/recording/images/video_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

namespace gpo {
namespace {

constexpr std::size_t kMostReordered = 16;  // frames between storing and showing one
constexpr int kStepsWorthDecoding = 8;      // rather than seeking to a key frame in between

[[noreturn]] void fail_to_open(const fs::path& file) {
  refuse(file, "cannot decode: truncated, or not a video");
}

struct Orientation {
  int quarter_turns = 0;  ///< clockwise, before mirroring
  bool mirrored = false;
};

/// A mirrored image would contradict the gyroscope and the truth, so only the rotation is applied.
Orientation orientation_of(const AVStream& stream) {
  const std::int32_t* shown = libav::display_matrix(stream);
  if (shown == nullptr) return {};
  std::array<std::int32_t, 9> matrix{};
  std::copy_n(shown, matrix.size(), matrix.begin());
  const auto element = [&](int i) { return static_cast<double>(matrix[i]); };
  const bool mirrored = element(0) * element(4) < element(1) * element(3);
  if (mirrored) libav::av_display_matrix_flip(matrix.data(), 1, 0);
  const double turns = -libav::av_display_rotation_get(matrix.data()) / 90;
  if (!std::isfinite(turns)) return {0, mirrored};
  return {((static_cast<int>(std::lround(turns)) % 4) + 4) % 4, mirrored};
}

/// Returns the width of a stored pixel divided by its height.
double pixel_aspect_of(const AVStream& stream) {
  constexpr double kMost = 4;
  const AVRational& of_container = stream.sample_aspect_ratio;
  const double aspect =
      av_q2d(of_container.num > 0 ? of_container : stream.codecpar->sample_aspect_ratio);
  return aspect >= 1 / kMost && aspect <= kMost ? aspect : 1;
}

/// Returns whether the video may be interlaced: its stream says so, or says nothing. No interlaced
/// format has more rows than 1080, and encoders of these codecs have none.
bool may_be_interlaced(const AVCodecParameters& codec) {
  constexpr int kMostRows = 1088;
  constexpr std::array kProgressive = {
      AV_CODEC_ID_HEVC, AV_CODEC_ID_VP8, AV_CODEC_ID_VP9, AV_CODEC_ID_AV1};
  if (codec.height > kMostRows || codec.field_order == AV_FIELD_PROGRESSIVE) return false;
  return codec.field_order != AV_FIELD_UNKNOWN ||
         std::ranges::find(kProgressive, codec.codec_id) == kProgressive.end();
}

/// Returns whether frames are missing because the file was truncated.
bool is_truncated(const fs::path& file, const VideoIndex& index) {
  const double found = static_cast<double>(index.times.size()) + index.hidden_count;
  const double missing = index.declared_count - found;
  return missing > std::max(2.0, index.declared_count / 100) && ends_early(file);
}

std::vector<std::int64_t> timestamps_ns(const VideoIndex& index) {
  std::vector<std::int64_t> times;
  for (const std::int64_t time : index.times)
    times.push_back(
        std::llround(static_cast<double>(time - index.times.front()) * index.unit_s * 1e9));
  return times;
}

std::vector<std::string> notes_of(const VideoIndex& index) {
  std::vector<std::string> notes;
  if (index.mirrored)
    notes.emplace_back("players mirror this video: its images are read as stored");
  if (index.damaged.empty()) return notes;
  const std::int64_t first =
      std::max<std::int64_t>(0, std::ranges::min(index.damaged) - index.times.front());
  notes.push_back(
      fmt::format("the video lacks data of {}, first at {:.3f} s: these are left out, and images "
                  "after them may be wrong up to the next key frame",
                  counted(index.damaged.size(), "frame"),
                  static_cast<double>(first) * index.unit_s));
  return notes;
}

}  // namespace

struct VideoDecoder::Input {
  libav::Format format;
  AVStream* stream = nullptr;
  libav::Codec codec;
  libav::Packet packet{libav::av_packet_alloc()};
  libav::Frame frame{libav::av_frame_alloc()};
  libav::BgrConverter convert;

  explicit Input(const fs::path& file) : format(libav::open_input(file, libav::kVideoContainers)) {
    if (!format || libav::avformat_find_stream_info(format.get(), nullptr) < 0) {
      check_stop();
      fail_to_open(file);
    }
    codec = libav::open_decoder(*format, 0, stream);
    if (!codec) fail_to_open(file);
    for (unsigned i = 0; i < format->nb_streams; ++i)
      if (format->streams[i] != stream) format->streams[i]->discard = AVDISCARD_ALL;
  }

  bool read_packet() { return libav::read_packet(*format, *stream, *packet); }

  void report(const ReadProgress& progress) const {
    if (!progress) return;
    const double bytes = 1 + static_cast<double>(libav::avio_size(format->pb));
    progress(static_cast<double>(libav::avio_seek(format->pb, 0, SEEK_CUR)) / bytes);
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

  cv::Mat image(const fs::path& file, std::optional<FieldOrder> fields) {
    cv::Mat bgr = convert(*frame);
    if (bgr.empty()) fail_to_open(file);
    if (fields) bgr = first_field(bgr, *fields);
    const int turns = orientation_of(*stream).quarter_turns;
    if (turns > 0) cv::rotate(bgr, bgr, turns - 1);
    return bgr;
  }
};

VideoDecoder::VideoDecoder(fs::path file, const ReadProgress& progress, int first_frames)
    : file_(std::move(file)), input_(std::make_unique<Input>(file_)) {
  const AVStream& stream = *input_->stream;
  index_.unit_s = av_q2d(stream.time_base);
  index_.size = {stream.codecpar->width, stream.codecpar->height};
  check_image_size(file_.string(),
                   static_cast<std::uint64_t>(index_.size.width),
                   static_cast<std::uint64_t>(index_.size.height));
  const Orientation orientation = orientation_of(stream);
  index_.quarter_turns = orientation.quarter_turns;
  index_.mirrored = orientation.mirrored;
  if (index_.quarter_turns % 2 == 1) std::swap(index_.size.width, index_.size.height);
  index_.pixel_aspect = pixel_aspect_of(stream);
  if (index_.quarter_turns % 2 == 1) index_.pixel_aspect = 1 / index_.pixel_aspect;
  const double rate = av_q2d(stream.avg_frame_rate);
  if (std::isfinite(rate)) index_.rate_hz = rate;
  index_.declared_count = declared_count(*input_->format, stream);
  index_.estimated_count = stream.nb_frames <= 0;
  const bool checked = may_be_interlaced(*stream.codecpar);
  if (!index_packets(progress, first_frames)) count_frames(progress);
  restart();
  if (checked) find_fields();
}

/// Decides by the motion at some places of the video: progressive ones are often declared as
/// interlaced, and interlaced ones not.
void VideoDecoder::find_fields() {
  constexpr int kPlaces = 6, kMostSteps = 48;  // steps from a key frame
  const bool timed = numbering_ == Numbering::by_time;
  const int most = static_cast<int>(index_.times.size()) - 2;
  std::vector<double> motions;
  try {
    for (int place = 0; place < kPlaces && most >= 0; ++place) {
      int frame = static_cast<int>(std::int64_t{most} * place / (kPlaces - 1));
      if (timed) {
        const auto key = std::ranges::upper_bound(index_.key_times, index_.times[frame]);
        const auto whole = key == index_.key_times.begin()
                               ? index_.times.begin()
                               : std::ranges::lower_bound(index_.times, *std::prev(key));
        const int first = static_cast<int>(whole - index_.times.begin());
        frame = std::min(frame, first + kMostSteps);
      } else {
        frame = std::min(frame, place * kMostSteps);
      }
      cv::Mat images[] = {decode(frame), decode(frame + 1)};
      for (cv::Mat& image : images)
        if (index_.quarter_turns > 0) cv::rotate(image, image, 3 - index_.quarter_turns);
      std::ranges::copy(field_motions(images[0], images[1]), std::back_inserter(motions));
    }
  } catch (const InputError&) {
    motions.clear();  // opening or reading the images reports broken ones
  }
  index_.fields = field_order(motions);
  kept_.clear();
  restart();
}

/// Lists the frames by the packets' times. Returns false if these are unknown or repeated.
bool VideoDecoder::index_packets(const ReadProgress& progress, int first_frames) {
  const Budget budget(file_);
  AVFormatContext& format = *input_->format;
  const std::vector<IndexEntry> entries = index_entries(format, *input_->stream);
  std::optional<PacketTimes> indexed;
  if (!entries.empty()) {
    spend_items(file_, entries.size());
    indexed = indexed_times(format, *input_->stream, entries);
    if (!indexed) input_ = std::make_unique<Input>(file_);  // the comparison has moved it
  }
  PacketTimes times = indexed ? std::move(*indexed) : read_packets(progress, first_frames);
  times.finish();
  index_.times = std::move(times.all);
  index_.key_times = std::move(times.keys);
  index_.hidden_count = times.hidden;
  index_.damaged = std::move(times.damaged);
  if (times.exact && times.before_keys && !index_.key_times.empty()) drop_undecodable();
  return times.exact;
}

PacketTimes VideoDecoder::read_packets(const ReadProgress& progress, int first_frames) {
  PacketTimes times;
  while (input_->read_packet()) {
    spend_items(file_);
    times.add(*input_->packet, *input_->stream->codecpar);
    input_->report(progress);
    if (first_frames == 0 || std::ssize(times.all) != first_frames) continue;
    PacketTimes first = times;
    first.finish();
    if (!first.exact) continue;  // only decoding all can count them
    // Packets that follow may be shown before the last ones.
    first.all.resize(first.all.size() - std::min<std::size_t>(first.all.size(), kMostReordered));
    index_.complete = false;
    return first;
  }
  return times;
}

/// Drops frames at the beginning whose references are missing: a recording that was cut there
/// without encoding it again begins with them.
void VideoDecoder::drop_undecodable() {
  restart();
  const std::int64_t key_time = index_.key_times.front();
  const auto first_whole = std::ranges::lower_bound(index_.times, key_time);
  std::vector<std::int64_t> kept(first_whole, index_.times.end());
  for (int frame = next_frame(); frame >= 0 && index_.times[frame] < key_time; frame = next_frame())
    if (!libav::is_damaged(*input_->frame)) kept.push_back(index_.times[frame]);
  std::ranges::sort(kept);
  index_.hidden_count += static_cast<int>(index_.times.size() - kept.size());
  index_.times = std::move(kept);
}

/// Lists the frames by decoding all of them.
void VideoDecoder::count_frames(const ReadProgress& progress) {
  const Budget budget(file_);
  const std::uint64_t file_bytes = fs::file_size(file_);
  restart();
  numbering_ = Numbering::by_count;
  index_.times.clear();
  std::vector<std::int64_t> shown;
  const double period = 1 / (index_.unit_s * (index_.rate_hz > 0 ? index_.rate_hz : 30.0));
  for (int frame = next_frame(); frame >= 0; frame = next_frame()) {
    spend_items(file_);
    spend_pixels(file_, file_bytes, static_cast<std::uint64_t>(index_.size.area()));
    index_.times.push_back(std::llround(frame * period));
    shown.push_back(input_->frame->best_effort_timestamp);
    input_->report(progress);
  }
  const bool known = std::ranges::find(shown, AV_NOPTS_VALUE) == shown.end();
  const bool ascending = std::ranges::adjacent_find(shown, std::greater_equal()) == shown.end();
  if (known && ascending) index_.times = std::move(shown);
}

VideoDecoder::~VideoDecoder() = default;

void VideoDecoder::restart() {
  input_.reset();
  state_ = State::begin;
}

/// Decodes the next frame. Returns its number, or -1 at the end.
int VideoDecoder::next_frame() {
  if (!input_) input_ = std::make_unique<Input>(file_);
  const auto decode_frame = [this] {
    try {
      return input_->decode_frame();
    } catch (const Stopped&) {
      restart();  // a packet may be lost
      throw;
    }
  };
  while (decode_frame()) {
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
    cv::Mat image = input_->image(file_, index_.fields);
    if (decoded == frame) return image;
    kept_[decoded] = std::move(image);
  }
}

VideoFile open_video(const fs::path& file,
                     Camera& camera,
                     std::size_t cache_bytes,
                     const ReadProgress& progress,
                     int first_frames) {
  if (!is_file(file)) refuse(file, "no such file");
  const auto decoder = std::make_shared<VideoDecoder>(file, progress, first_frames);
  const VideoIndex& index = decoder->index();
  if (index.times.empty() || (index.complete && is_truncated(file, index)))
    refuse(file,
           "found {} frames (the file seems truncated), expected {}{}",
           index.times.size(),
           index.estimated_count ? "about " : "",
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
          .quarter_turns = index.quarter_turns,
          .pixel_aspect = index.pixel_aspect,
          .first_field = !index.fields                            ? ""
                         : *index.fields == FieldOrder::top_first ? "top"
                                                                  : "bottom",
          .notes = notes_of(index),
          .complete = index.complete};
}

}  // namespace gpo
