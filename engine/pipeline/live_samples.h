// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace gpo {

/// How the samples cover the window up to a frame.
struct Coverage {
  enum class Kind {
    complete,  ///< over the whole window
    none,      ///< no samples within the window, and none are expected
    waiting,   ///< samples may still come
    broken     ///< a part of the window has no samples
  };
  Kind kind = Kind::complete;
  std::string reason = "";  ///< if broken: one line
};

/// Gyroscope samples as they come, at most of the last ten minutes. Not thread-safe.
class LiveSamples {
 public:
  /// Without a gyroscope until the first sample. Throws InputError for a bad one.
  explicit LiveSamples(const std::optional<Gyroscope>& given);

  /// Throws InputError, and adds nothing, for a sample out of order or with bad numbers.
  /// `acceleration_m_s2` may be null: that of all samples or of none. Ignores the sample after
  /// `close`, but for these checks.
  void add(std::int64_t timestamp_ns,
           const Eigen::Vector3d& rate_rad_s,
           const Eigen::Vector3d* acceleration_m_s2);
  void close() { closed_ = true; }
  /// Drops samples that no window from this frame on needs.
  void drop_before(std::int64_t frame_ns);

  // Times of frames are on the camera's clock.

  /// `newest_ns` is the time of the newest frame of all. `is_new`: the last frame was just added,
  /// so that it does not wait for a sample less than 1.5 periods away.
  Coverage coverage(std::int64_t first_ns,
                    std::int64_t last_ns,
                    std::int64_t newest_ns,
                    bool is_new) const;
  std::int64_t time_offset_ns() const { return gyroscope_ ? gyroscope_->time_offset_ns : 0; }
  /// Returns the time of the newest sample on the gyroscope's clock.
  std::int64_t newest_ns() const { return last_ns_.value_or(0); }
  /// Returns the gyroscope with the samples for a window, at most up to `until_ns` on the
  /// gyroscope's clock, without samples if that is nullopt; nullopt without a gyroscope.
  std::optional<Gyroscope> of_window(std::int64_t first_ns,
                                     std::int64_t last_ns,
                                     std::optional<std::int64_t> until_ns) const;

 private:
  struct Sample {
    std::int64_t timestamp_ns;
    InertialSample measured;
  };
  std::optional<Gyroscope> gyroscope_;  ///< without samples
  bool has_accelerations_ = false;
  std::deque<Sample> samples_;
  std::optional<std::int64_t> last_ns_;  ///< time of the last sample added
  bool closed_ = false;
};

}  // namespace gpo
