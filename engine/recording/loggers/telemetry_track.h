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

/// A piece of a telemetry track and its time in the container.
struct TelemetryPacket {
  double begin_s = 0;
  double end_s = 0;
  std::string bytes;
};

/// Telemetry that a camera stores beside the images in an MP4 or MOV.
struct TelemetryTrack {
  std::string format;  ///< "gpmd" (GoPro) or "camm" (Camera Motion Metadata)
  std::vector<TelemetryPacket> packets;
};

/// Reads the first such track of a video without decoding images; nullopt if there is none. Throws
/// InputError if it is too large.
std::optional<TelemetryTrack> read_telemetry_track(const std::filesystem::path& video);

/// Returns a GoPro's settings for the whole video, the box moov/udta/GPMF; empty if there are none.
std::string gopro_settings(const std::filesystem::path& video);

/// A sample of a Camera Motion Metadata (CAMM) track; most have one value.
struct CammSample {
  std::optional<Eigen::Vector3d> rates_rad_s;  ///< the gyroscope's axes
  std::optional<double> readout_s;             ///< from the first row to the last
};

/// Ignores unknown kinds of samples. Throws InputError with `source` for truncated samples and
/// rates that are not finite.
CammSample parse_camm(std::string_view bytes, const std::string& source);

/// Content of a box of an MP4 or MOV [bytes of the file].
struct MovieBox {
  std::uint64_t begin = 0, end = 0;
};

/// Finds boxes of an MP4 or MOV that FFmpeg ignores. Other files have none.
class MovieFile {
 public:
  explicit MovieFile(const std::filesystem::path& file);

  MovieBox all() const { return all_; }
  /// Finds the first box of a kind inside another one.
  std::optional<MovieBox> box_in(MovieBox outer, std::string_view kind);
  /// Finds a nested box by the kinds of all boxes from the outermost on.
  std::optional<MovieBox> box_at(std::initializer_list<std::string_view> kinds);
  /// Empty if it is larger than 1 MiB or unreadable.
  std::string bytes_of(MovieBox box);

 private:
  std::ifstream file_;
  MovieBox all_;
};

/// Finds a value by its key in the content of a box `meta` (QuickTime File Format, "Metadata");
/// returns numbers as text. nullopt if it is missing or unreadable.
std::optional<std::string> metadata_value(std::string_view meta, std::string_view key);

}  // namespace gpo
