// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

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

}  // namespace gpo
