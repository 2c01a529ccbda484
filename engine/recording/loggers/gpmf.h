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

/// When the first sample of a payload's stream was taken, in the camera's own clock.
struct GpmfStamp {
  std::int64_t first_sample = 0;    ///< counted from the beginning of the video
  std::optional<double> camera_us;  ///< STMP, or TICK
};

/// What one payload of a GoPro's telemetry (GPMF) says of the gyroscope and of the shutter.
struct GpmfPayload {
  std::vector<Eigen::Vector3d> rates_rad_s;  ///< GoPro's axes: x left, y back, z up
  GpmfStamp gyroscope;                       ///< of the first of these rates
  std::optional<GpmfStamp> exposures;        ///< of the first frame's exposure time (SHUT)
  std::optional<double> readout_s;           ///< SROT
};

/// Samples and exposures of the payloads so far, for cameras that do not count.
struct GpmfCount {
  std::int64_t rates = 0;
  std::int64_t exposures = 0;
};

/// Reads a payload, of which the first device with a gyroscope counts. Its samples are scaled
/// (SCAL), their axes put in order by what the camera says of them (MTRX with ORIO, or ORIN), else
/// by its model. `counted` is what the payloads before it held, and goes on. Throws InputError,
/// which names `source`.
GpmfPayload parse_gpmf(std::string_view bytes, const std::string& source, GpmfCount& counted);

/// Times of the samples of all payloads, relative to the first frame [ns]; one a rate. They lie on
/// the line that fits the camera's own stamps best, the first exposure being the first frame's;
/// without stamps on the line through the payloads' begins in the container, `payload_times_s`, of
/// which there is one more, the end of the last; the first frame is at 0 there. Empty where nothing
/// tells them.
std::vector<std::int64_t> gpmf_times_ns(const std::vector<GpmfPayload>& payloads,
                                        const std::vector<double>& payload_times_s);

/// A value in GPMF with its key; all numbers are big endian.
struct GpmfItem {
  std::string_view key;  ///< four letters
  char type = 0;         ///< a letter; 0: items inside
  int size = 0;          ///< of a sample [bytes]
  int count = 0;         ///< of samples
  std::string_view data;
};

/// Takes items off the front of what holds them.
class GpmfItems {
 public:
  GpmfItems(std::string_view bytes, const std::string& source) : rest_(bytes), source_(source) {}

  /// Nothing at the end, which may be padded by zeros. Throws InputError, which names `source`.
  std::optional<GpmfItem> next();

 private:
  std::string_view rest_;
  const std::string& source_;
};

/// All of its numbers, finite. Throws InputError.
std::vector<double> gpmf_numbers(const GpmfItem& item, const std::string& source);

/// Without the zeros at its end.
std::string gpmf_text(const GpmfItem& item);

}  // namespace gpo
