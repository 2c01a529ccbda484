// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
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

}  // namespace gpo
