// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/loggers/logs.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/recording/refuse.h"

#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSamples = 8'000'000;

/// GoPro's axes (x left, y back, z up, seen from behind) <- camera.
Pose camera_in_gopro() {
  return {(Eigen::Matrix3d() << -1, 0, 0, 0, 0, -1, 0, -1, 0).finished(), Eigen::Vector3d::Zero()};
}

/// Returns the readout time from the settings of the whole video, which some models have; nullopt
/// if they lack it or are unreadable.
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
         fmt::format("sample {} of the gyroscope not after the one before it", k + 1),
         "ascending times");
  }
  gyroscope.file = log.file;
  gyroscope.lines.resize(times.size());
  std::iota(gyroscope.lines.begin(), gyroscope.lines.end(), 1);
  log.gyroscope = std::move(gyroscope);
}

void check_count(const Log& log, const Gyroscope& gyroscope) {
  if (gyroscope.rates_rad_s.size() <= kMostSamples) return;
  fail(log, "too many samples", fmt::format("at most {}", kMostSamples));
}

void read_gopro(Log& log, const TelemetryTrack& track, double first_frame_s) {
  const std::string source = log.file.string() + ": telemetry";
  Gyroscope gyroscope;
  std::vector<GpmfPayload> payloads;
  std::vector<double> times_s;
  GpmfCount counted;
  for (const TelemetryPacket& packet : track.packets) {
    GpmfPayload payload = parse_gpmf(packet.bytes, source, counted);
    if (payload.readout_s) log.readout_s = payload.readout_s;
    gyroscope.rates_rad_s.insert(
        gyroscope.rates_rad_s.end(), payload.rates_rad_s.begin(), payload.rates_rad_s.end());
    check_count(log, gyroscope);
    payloads.push_back(std::move(payload));
    times_s.push_back(packet.begin_s - first_frame_s);
  }
  if (!track.packets.empty()) times_s.push_back(track.packets.back().end_s - first_frame_s);
  gyroscope.timestamps_ns = gpmf_times_ns(payloads, times_s);
  log.T_body_camera = camera_in_gopro();
  if (!log.readout_s) log.readout_s = readout_of_settings(log.file);
  take_samples(log, std::move(gyroscope));
}

void read_camm(Log& log, const TelemetryTrack& track, double first_frame_s) {
  constexpr double kMost_s = 4e9;
  const std::string source = log.file.string() + ": telemetry";
  Gyroscope gyroscope;
  for (const TelemetryPacket& packet : track.packets) {
    const CammSample sample = parse_camm(packet.bytes, source);
    if (sample.readout_s && !log.readout_s) log.readout_s = sample.readout_s;
    if (!sample.rates_rad_s) continue;
    const double time_s = packet.begin_s - first_frame_s;
    if (!(std::abs(time_s) < kMost_s)) fail(log, "another time", "one of the video's");
    gyroscope.timestamps_ns.push_back(std::llround(1e9 * time_s));
    gyroscope.rates_rad_s.push_back(*sample.rates_rad_s);
    check_count(log, gyroscope);
  }
  take_samples(log, std::move(gyroscope));
}

}  // namespace

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
  return std::nullopt;
}

std::optional<Log> log_inside(const fs::path& video, double first_frame_s) {
  const auto track = read_telemetry_track(video);
  if (!track) return std::nullopt;
  Log log;
  log.file = video;
  const auto read = track->format == "gpmd" ? read_gopro : read_camm;
  read(log, *track, first_frame_s);
  return log;
}

}  // namespace gpo
