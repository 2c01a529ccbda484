// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Number and time of the first sample of a payload's stream.
struct GpmfStamp {
  std::int64_t first_sample = 0;    ///< since the beginning of the video
  std::optional<double> camera_us;  ///< STMP or TICK, by the camera's clock
};

/// Gyroscope and shutter in one payload of a GoPro's telemetry (GPMF).
struct GpmfPayload {
  std::vector<Eigen::Vector3d> rates_rad_s;  ///< GoPro's axes: x left, y back, z up
  GpmfStamp gyroscope;                       ///< of the first of these rates
  std::optional<GpmfStamp> exposures;        ///< of the first exposure time (SHUT)
  std::optional<double> readout_s;           ///< SROT
};

/// Running counts of samples and exposures, for cameras that do not store them.
struct GpmfCount {
  std::int64_t rates = 0;
  std::int64_t exposures = 0;
};

/// Reads the first device with a gyroscope in a payload. Scales its samples (SCAL) and converts
/// their axes according to the file (MTRX with ORIO, or ORIN) or the camera's model. `counted` has
/// the counts of the previous payloads and is updated. Throws InputError with `source`.
GpmfPayload parse_gpmf(std::string_view bytes, const std::string& source, GpmfCount& counted);

/// Returns the times of all payloads' samples since the first frame [ns]. They are on the line
/// fitted to the camera's stamps, the first exposure being the first frame's. Without stamps they
/// are on the line through the payloads' begins in the container, `payload_times_s`, with the end
/// of the last as an additional entry and the first frame at 0. Empty if the times are unknown.
std::vector<std::int64_t> gpmf_times_ns(const std::vector<GpmfPayload>& payloads,
                                        const std::vector<double>& payload_times_s);

/// A GPMF value and its key; numbers are big-endian.
struct GpmfItem {
  std::string_view key;  ///< four letters
  char type = 0;         ///< a letter; 0: nested items
  int size = 0;          ///< of a sample [bytes]
  int count = 0;         ///< of samples
  std::string_view data;
};

/// Iterates over the items in a buffer.
class GpmfItems {
 public:
  GpmfItems(std::string_view bytes, const std::string& source) : rest_(bytes), source_(source) {}

  /// Returns the next item; nullopt at the end or in the padding. Throws InputError with `source`.
  std::optional<GpmfItem> next();

 private:
  std::string_view rest_;
  const std::string& source_;
};

/// Returns all numbers of an item, finite. Throws InputError.
std::vector<double> gpmf_numbers(const GpmfItem& item, const std::string& source);

/// Returns the text without the zeros at its end.
std::string gpmf_text(const GpmfItem& item);

/// Returns the rotation for three named axes, upper case for an axis and lower case for its
/// opposite: "YxZ" has the rows e_y, -e_x, e_z. nullopt if the text is invalid or left-handed.
std::optional<Eigen::Matrix3d> signed_axes(std::string_view text);
}  // namespace gpo
