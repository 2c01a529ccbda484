// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo::test {

/// A piece of telemetry and its time.
struct TelemetryPiece {
  std::int64_t time_ms = 0;
  std::int64_t length_ms = 0;
  std::string bytes;
};

/// Options that OpenCV's writer lacks.
struct VideoOptions {
  bool b_frames = false;    ///< MPEG-4, one key frame in 12 and two B-frames between others
  std::string codec{};      ///< FFmpeg's name of an encoder; empty: see `make_video`
  bool pq = false;          ///< 10 bits by SMPTE ST 2084 (HDR), lossless, for VP9
  bool full_range = false;  ///< declares the full range; the values remain as they are
  /// Declares interlaced frames: whether the top field is first. The images remain as they are.
  std::optional<bool> top_field_first{};
  bool mirrored = false;                   ///< horizontally by the player, after the rotation
  int clockwise_degrees = 0;               ///< rotation by the player; MP4 and MOV only
  std::pair<int, int> pixel_aspect{1, 1};  ///< width and height of a pixel
  std::vector<int> times_ms{};             ///< one for each image; default: 25 frames per second
  std::map<std::string, std::string> metadata{};  ///< for the whole file
  std::string telemetry_format{};                 ///< "gpmd" or "camm"; empty: no telemetry track
  std::vector<TelemetryPiece> telemetry{};
};

/// Writes MJPEG (or MPEG-4 with B-frames) in the container that the file's name asks for; MPEG-2 in
/// `ts`. Frames before the time 0 are hidden by an edit list in MP4 and MOV.
void make_video(const std::filesystem::path& file,
                const std::vector<cv::Mat>& images,
                const VideoOptions& options = {});

/// Returns a GPMF item; type 0 is for nested items, `size` is that of a sample.
std::string gpmf_item(const std::string& key, char type, int size, const std::string& data);
/// Returns the concatenated big-endian numbers, each of `size` bytes.
std::string big_endian(const std::vector<std::int64_t>& values, int size);

// Samples of a CAMM track.
std::string camm_rates(float x, float y, float z);
std::string camm_exposure(std::int32_t exposure_ns, std::int32_t skew_ns);

}  // namespace gpo::test
