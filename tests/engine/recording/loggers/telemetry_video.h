// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace gpo::test {

/// A piece of telemetry, and when it is.
struct TelemetryPiece {
  std::int64_t time_ms = 0;
  std::int64_t length_ms = 0;
  std::string bytes;
};

/// Adds a track to an MP4, as FFmpeg writes it: "gpmd" or "camm".
void add_telemetry(const std::filesystem::path& video,
                   const std::string& format,
                   const std::vector<TelemetryPiece>& pieces);

/// Items of GPMF by the letter of its documentation: key, type (0: items inside), size of a sample,
/// and the samples' bytes.
std::string gpmf_item(const std::string& key, char type, int size, const std::string& data);
/// Big endian, one after the other, of so many bytes each.
std::string big_endian(const std::vector<std::int64_t>& values, int size);

/// A sample of a CAMM track: its kind, then numbers of four bytes, little endian.
std::string camm_rates(float x, float y, float z);
std::string camm_exposure(std::int32_t exposure_ns, std::int32_t skew_ns);

}  // namespace gpo::test
