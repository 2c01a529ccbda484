// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/companion_files.h"
#include "engine/recording/images/libav.h"
#include "engine/recording/loggers/logs.h"

#include <bit>
#include <cmath>
#include <numeric>

namespace gpo {
namespace {

using Bytes = std::string_view;

std::string tag_of(const AVStream& stream) {
  const unsigned tag = stream.codecpar->codec_tag;
  std::string letters;
  for (int k = 0; k < 4; ++k) letters += static_cast<char>(tag >> 8 * k & 0xFF);
  return letters;
}

AVStream* telemetry_stream(AVFormatContext& format) {
  AVStream* found = nullptr;
  for (unsigned i = 0; i < format.nb_streams; ++i) {
    AVStream* stream = format.streams[i];
    const std::string tag = tag_of(*stream);
    if (found == nullptr && (tag == "gpmd" || tag == "camm"))
      found = stream;
    else
      stream->discard = AVDISCARD_ALL;
  }
  return found;
}

constexpr std::size_t kHead = 4;  // two reserved bytes, two with the kind
constexpr std::uint64_t kExposure = 1;
constexpr std::uint64_t kGyroscope = 2;
constexpr std::uint64_t kAcceleration = 3;

constexpr std::uint64_t kMostBoxBytes = 1 << 20;
constexpr int kMostBoxes = 10'000;

std::uint64_t number_of(Bytes bytes) { return big_endian(bytes, 0, bytes.size()); }

/// A box in memory; for a key the kind is its namespace.
struct MemoryBox {
  Bytes kind;
  Bytes data;
};

/// Takes a box off the front of its container; nullopt at the end, and if it is truncated.
std::optional<MemoryBox> take_box(Bytes& rest) {
  constexpr std::size_t kHead = 8;
  if (rest.size() < kHead) return std::nullopt;
  const std::uint64_t length = number_of(rest.substr(0, 4));
  if (length < kHead || length > rest.size()) return std::nullopt;
  const MemoryBox box{rest.substr(4, 4), rest.substr(kHead, length - kHead)};
  rest.remove_prefix(length);
  return box;
}

Bytes data_in(Bytes outer, Bytes kind) {
  while (const auto box = take_box(outer))
    if (box->kind == kind) return box->data;
  return {};
}

/// Returns a key's place in the list, from 1, which is the kind of its value's box; 0 if missing.
std::uint64_t place_of(Bytes keys, Bytes key) {
  constexpr std::size_t kVersionAndCount = 8;
  if (keys.size() < kVersionAndCount) return 0;
  keys.remove_prefix(kVersionAndCount);
  for (std::uint64_t place = 1; const auto found = take_box(keys); ++place)
    if (found->kind == "mdta" && found->data == key) return place;
  return 0;
}

std::optional<std::string> text_of(std::uint64_t type, Bytes value) {
  enum { kUtf8 = 1, kSigned = 21, kUnsigned = 22, kFloat = 23, kDouble = 24 };
  const std::uint64_t bits = number_of(value.substr(0, 8));
  const bool is_number = !value.empty() && value.size() <= 8;
  if (type == kUtf8) return std::string(value.substr(0, value.find('\0')));
  if (type == kUnsigned && is_number) return std::to_string(bits);
  if (type == kSigned && is_number) {
    const auto unused = static_cast<int>(64 - 8 * value.size());
    return std::to_string(static_cast<std::int64_t>(bits << unused) >> unused);
  }
  if (type == kFloat && value.size() == 4)
    return fmt::format("{}", std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
  if (type == kDouble && value.size() == 8) return fmt::format("{}", std::bit_cast<double>(bits));
  return std::nullopt;
}

/// Some models have the readout time in the settings of the whole video.
std::optional<double> readout_of_settings(const fs::path& video) {
  try {
    GpmfCount counted;
    return parse_gpmf(gopro_settings(video), video.string(), counted).readout_s;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

[[noreturn]] void fail(const Log& log, const std::string& found, const std::string& expected) {
  refuse(log.file, "telemetry: found {}, expected {}", found, expected);
}

void take_samples(Log& log, Gyroscope gyroscope) {
  const auto& times = gyroscope.timestamps_ns;
  if (gyroscope.rates_rad_s.empty()) return;
  if (times.size() != gyroscope.rates_rad_s.size()) fail(log, "no times", "a running clock");
  for (std::size_t k = 1; k < times.size(); ++k) {
    if (times[k] > times[k - 1]) continue;
    fail(log,
         fmt::format("sample {} of the gyroscope not later than the previous one", k + 1),
         "ascending times");
  }
  gyroscope.file = log.file;
  gyroscope.lines.resize(times.size());
  std::iota(gyroscope.lines.begin(), gyroscope.lines.end(), 1);
  log.gyroscope = std::move(gyroscope);
}

void read_gopro(Log& log, const TelemetryTrack& track, double first_frame_s) {
  const std::string source = log.file.string() + ": telemetry";
  Gyroscope gyroscope;
  AccelerationSamples accelerations;
  std::vector<GpmfPayload> payloads;
  std::vector<double> times_s;
  GpmfCount counted;
  for (const TelemetryPacket& packet : track.packets) {
    GpmfPayload payload = parse_gpmf(packet.bytes, source, counted);
    if (payload.readout_s) log.readout_s = payload.readout_s;
    const auto append = [](const GpmfSamples& from, std::vector<Eigen::Vector3d>& to) {
      to.insert(to.end(), from.values.begin(), from.values.end());
    };
    spend_items(log.file,
                payload.rates_rad_s.values.size() + payload.accelerations_m_s2.values.size());
    append(payload.rates_rad_s, gyroscope.rates_rad_s);
    append(payload.accelerations_m_s2, accelerations.specific_force);
    payloads.push_back(std::move(payload));
    times_s.push_back(packet.begin_s - first_frame_s);
  }
  if (!track.packets.empty()) times_s.push_back(track.packets.back().end_s - first_frame_s);
  gyroscope.timestamps_ns = gpmf_times_ns(payloads, times_s, &GpmfPayload::rates_rad_s);
  accelerations.timestamps_ns = gpmf_times_ns(payloads, times_s, &GpmfPayload::accelerations_m_s2);
  // GoPro's axes: x left, y back, z up, seen from behind.
  log.T_body_camera.emplace().R_wc << -1, 0, 0, 0, 0, -1, 0, -1, 0;
  if (!log.readout_s) log.readout_s = readout_of_settings(log.file);
  if (const auto flags = stabilization_of_gpmf(gopro_settings(log.file)); !flags.empty())
    log.notes.push_back(fmt::format(
        "the GoPro's settings state that it stabilizes the images ({}): its gyroscope and a "
        "calibration describe images without stabilization; switch it off",
        flags));
  take_samples(log, std::move(gyroscope));
  if (log.gyroscope) add_accelerations(accelerations, *log.gyroscope);
}

void read_camm(Log& log, const TelemetryTrack& track, double first_frame_s) {
  constexpr double kMost_s = 4e9;
  const std::string source = log.file.string() + ": telemetry";
  Gyroscope gyroscope;
  AccelerationSamples accelerations;
  for (const TelemetryPacket& packet : track.packets) {
    const CammSample sample = parse_camm(packet.bytes, source);
    if (sample.readout_s && !log.readout_s) log.readout_s = sample.readout_s;
    if (!sample.rates_rad_s && !sample.accelerations_m_s2) continue;
    const double time_s = packet.begin_s - first_frame_s;
    if (!(std::abs(time_s) < kMost_s)) fail(log, "an implausible time", "a time within the video");
    if (sample.accelerations_m_s2) {
      spend_items(log.file);
      accelerations.timestamps_ns.push_back(std::llround(1e9 * time_s));
      accelerations.specific_force.push_back(*sample.accelerations_m_s2);
      continue;
    }
    gyroscope.timestamps_ns.push_back(std::llround(1e9 * time_s));
    spend_items(log.file);
    gyroscope.rates_rad_s.push_back(*sample.rates_rad_s);
  }
  take_samples(log, std::move(gyroscope));
  if (log.gyroscope) add_accelerations(accelerations, *log.gyroscope);
}

Eigen::Vector3d camm_vector(std::string_view bytes, const std::string& source, const char* what) {
  Eigen::Vector3d vector;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto bits = static_cast<std::uint32_t>(little_endian(bytes, kHead + 4 * k, 4));
    vector[static_cast<int>(k)] = static_cast<double>(std::bit_cast<float>(bits));
  }
  if (!vector.allFinite()) refuse(source, "{} is not finite", what);
  return vector;
}

}  // namespace

std::optional<TelemetryTrack> read_telemetry_track(const fs::path& video) {
  const libav::Format format = libav::open_input(video, "mov");
  AVStream* stream = format ? telemetry_stream(*format) : nullptr;
  if (stream == nullptr) return std::nullopt;
  TelemetryTrack track{tag_of(*stream), {}};
  const double unit_s = av_q2d(stream->time_base);
  const libav::Packet packet(libav::av_packet_alloc());
  std::size_t bytes = 0;
  for (; libav::av_read_frame(format.get(), packet.get()) >= 0;
       libav::av_packet_unref(packet.get())) {
    if (packet->stream_index != stream->index || packet->pts == AV_NOPTS_VALUE) continue;
    bytes += static_cast<std::size_t>(packet->size) + sizeof(TelemetryPacket);
    if (bytes > limits().file_bytes)
      refuse_size(video,
                  fmt::format("telemetry of more than {} MiB", limits().file_bytes >> 20),
                  "less telemetry");
    const auto begin = static_cast<double>(packet->pts);
    track.packets.push_back(
        {unit_s * begin,
         unit_s * (begin + static_cast<double>(packet->duration)),
         std::string(reinterpret_cast<const char*>(packet->data), packet->size)});
  }
  return track;
}

std::string gopro_settings(const fs::path& video) {
  const FileBytes movie(video);
  const auto box = box_at(movie, {"moov", "udta", "GPMF"});
  return box ? bytes_of(movie, *box) : "";
}

CammSample parse_camm(std::string_view bytes, const std::string& source) {
  const auto need = [&](std::size_t length) {
    if (bytes.size() >= length) return;
    refuse(source, "found a sample of {} bytes (truncated), expected {}", bytes.size(), length);
  };
  need(kHead);
  CammSample sample;
  const std::uint64_t kind = little_endian(bytes, 2, 2);
  if (kind == kExposure) {
    need(kHead + 8);
    const auto skew_ns = static_cast<std::int32_t>(little_endian(bytes, kHead + 4, 4));
    sample.readout_s = 1e-9 * skew_ns;
  }
  if (kind == kGyroscope) {
    need(kHead + 12);
    sample.rates_rad_s = camm_vector(bytes, source, "a rate");
  }
  if (kind == kAcceleration) {
    need(kHead + 12);
    sample.accelerations_m_s2 = camm_vector(bytes, source, "an acceleration");
  }
  return sample;
}

std::optional<MovieBox> box_in(const FileBytes& movie, MovieBox outer, Bytes kind) {
  for (int k = 0; k < kMostBoxes && outer.begin + 8 <= outer.end; ++k) {
    const std::string head = movie.read(outer.begin, 16);
    std::uint64_t length = big_endian(head, 0, 4);
    std::uint64_t head_length = 8;
    if (length == 1) {
      length = big_endian(head, 8, 8);
      head_length = 16;
    } else if (length == 0) {
      length = outer.end - outer.begin;
    }
    if (head.size() < head_length || length < head_length || length > outer.end - outer.begin)
      return std::nullopt;
    if (head.substr(4, 4) == kind) return MovieBox{outer.begin + head_length, outer.begin + length};
    outer.begin += length;
  }
  return std::nullopt;
}

std::optional<MovieBox> box_at(const FileBytes& movie, std::initializer_list<Bytes> kinds) {
  std::optional<MovieBox> box = MovieBox{0, movie.size()};
  for (const Bytes kind : kinds)
    if (box) box = box_in(movie, *box, kind);
  return box;
}

std::string bytes_of(const FileBytes& movie, MovieBox box) {
  const std::uint64_t size = box.end - box.begin;
  return size > kMostBoxBytes ? "" : movie.read(box.begin, size);
}

std::optional<std::string> metadata_value(Bytes meta, Bytes key) {
  // QuickTime's content begins with its first box, MPEG's with a version.
  if (meta.size() >= 12 && meta.substr(4, 4) != "hdlr" && meta.substr(8, 4) == "hdlr")
    meta.remove_prefix(4);
  const std::uint64_t place = place_of(data_in(meta, "keys"), key);
  Bytes values = data_in(meta, "ilst");
  while (const auto value = place > 0 ? take_box(values) : std::nullopt) {
    if (number_of(value->kind) != place) continue;
    const Bytes data = data_in(value->data, "data");
    constexpr std::size_t kTypeAndLocale = 8;
    if (data.size() < kTypeAndLocale) return std::nullopt;
    return text_of(number_of(data.substr(0, 4)), data.substr(kTypeAndLocale));
  }
  return std::nullopt;
}

std::optional<Log> log_beside(const fs::path& folder, const std::optional<fs::path>& video) {
  if (is_file(folder / "odometry.csv") && is_file(folder / "camera_matrix.csv"))
    return read_stray_scanner(folder);
  // The name data.jsonl alone is too common.
  if (video && video->stem() == "data")
    if (const auto file = if_file(folder / "data.jsonl")) return read_spectacular(*file);
  if (video)
    if (const auto file = if_file(fs::path(*video).replace_extension(".gcsv")))
      return read_gcsv(*file);
  if (const auto file = if_file(folder / "Gyroscope.csv")) return read_sensor_logger(*file);
  const bool frames = is_file(folder / "Frames.txt") || is_file(folder / "frames.csv");
  if (video && frames && lower_case(video->stem().string()) == "frames")
    return read_ios_logger(folder);
  return std::nullopt;
}

std::optional<Log> log_inside(const fs::path& video, double first_frame_s) {
  const Budget budget(video);
  const auto track = read_telemetry_track(video);
  if (!track) return std::nullopt;
  Log log;
  log.file = video;
  const auto read = track->format == "gpmd" ? read_gopro : read_camm;
  read(log, *track, first_frame_s);
  return log;
}

}  // namespace gpo
