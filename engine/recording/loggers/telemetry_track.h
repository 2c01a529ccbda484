// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A piece of a telemetry track, and when the container says that it is.
struct TelemetryPacket {
  double begin_s = 0;
  double end_s = 0;
  std::string bytes;
};

/// What cameras store beside the pictures in an MP4 or MOV.
struct TelemetryTrack {
  std::string format;  ///< "gpmd" (GoPro) or "camm" (Camera Motion Metadata)
  std::vector<TelemetryPacket> packets;
};

/// The first such track of a video, decoding nothing; nothing where there is none. Throws
/// InputError where it is larger than can be kept.
std::optional<TelemetryTrack> read_telemetry_track(const std::filesystem::path& video);

/// What a GoPro says of the whole video, the box moov/udta/GPMF; empty where there is none.
std::string gopro_settings(const std::filesystem::path& video);

/// What a sample of a Camera Motion Metadata (CAMM) track says; most say one thing.
struct CammSample {
  std::optional<Eigen::Vector3d> rates_rad_s;  ///< the gyroscope's axes
  std::optional<double> readout_s;             ///< from the first row to the last
};

/// Kinds of samples that are not known are passed over. Throws InputError, which names `source`:
/// one that is cut, or rates that are no numbers.
CammSample parse_camm(std::string_view bytes, const std::string& source);

/// Where a box of an MP4 or MOV holds what it holds [bytes of the file].
struct MovieBox {
  std::uint64_t begin = 0, end = 0;
};

/// The boxes of an MP4 or MOV that FFmpeg passes over. Any other file has none.
class MovieFile {
 public:
  explicit MovieFile(const std::filesystem::path& file);

  MovieBox all() const { return all_; }
  /// The first box of that kind inside of another one.
  std::optional<MovieBox> box_in(MovieBox outer, std::string_view kind);
  /// By the kinds of the boxes that hold each other, from the outermost on.
  std::optional<MovieBox> box_at(std::initializer_list<std::string_view> kinds);
  /// Empty where it is larger than 1 MiB, or cannot be read.
  std::string bytes_of(MovieBox box);

 private:
  std::ifstream file_;
  MovieBox all_;
};

/// A value, by its key, of what a box `meta` holds (QuickTime File Format, "Metadata"); a number as
/// text. Nothing where it has none, or cannot be read.
std::optional<std::string> metadata_value(std::string_view meta, std::string_view key);

}  // namespace gpo
