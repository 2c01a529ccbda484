// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// The clock of live images, replaced in tests.
struct LiveClock {
  std::function<std::int64_t()> now_ns;  ///< since 1970 [ns]; never goes back
  /// Returns at this time, or at once if stopped.
  std::function<void(std::int64_t time_ns, const std::stop_token& stop)> wait_until;
};

LiveClock real_clock();

struct TimedImage {
  cv::Mat bgr;  ///< CV_8UC3
  std::int64_t timestamp_ns = 0;
};

/// How a source is read by the thread that opens it.
struct SourceContext {
  const LiveClock& clock;
  std::stop_token stop;
  /// Called at least ten times per second while it waits for data; true: it must return.
  std::function<bool()> interrupted;
};

/// A connected source.
struct OpenSource {
  /// Identifies the camera across connections, "camera:HD Webcam C270".
  std::string device;
  /// Waits for the next image; nullopt if there are no more, or if interrupted. Throws InputError.
  std::function<std::optional<TimedImage>()> read;
  std::function<int()> broken = [] { return 0; };  ///< damaged parts that were skipped so far
};

/// A source that the user typed or chose: "camera:0", "udp://127.0.0.1:5000", a video or a
/// recording.
struct SourceAddress {
  std::string text;
  /// The opened recording of `text` if it is a file; null for a device or a stream.
  std::shared_ptr<const Recording> recording = nullptr;
};

/// One kind of source.
struct SourceRow {
  std::string_view prefix;  ///< begins its addresses; "" matches any file
  bool is_live;             ///< opens a device or the network, so only the user may name it
  /// Throws InputError "ADDRESS: reason".
  OpenSource (*open)(const SourceAddress& address, const SourceContext& context);
  /// Formats and protocols that a stream may use. Without the lists it could name further URLs and
  /// files. null: no stream.
  const char* formats = nullptr;
  const char* protocols = nullptr;

  /// Returns whether it is connected again after it broke off.
  bool reconnects() const { return formats != nullptr; }
};

/// Returns the row of an address; the last one for files.
const SourceRow& source_row(const std::string& address);

/// Returns whether an address names a device or the network.
inline bool is_live_address(const std::string& address) { return source_row(address).is_live; }

OpenSource open_camera(const SourceAddress& address, const SourceContext& context);
OpenSource open_stream(const SourceAddress& address, const SourceContext& context);
/// Plays the images of a recording in real time, by the clock.
OpenSource open_player(const SourceAddress& address, const SourceContext& context);

struct CameraMode {
  cv::Size size;       ///< [px]
  double rate_hz = 0;  ///< highest; 0: unknown

  bool operator==(const CameraMode&) const = default;
};

/// A camera of this computer.
struct CameraDevice {
  int number = 0;                 ///< "camera:NUMBER"
  std::string name;               ///< by its driver, "HD Webcam C270"
  std::vector<CameraMode> modes;  ///< largest first
};

/// Lists the V4L2 cameras that this user may open, by number. Takes no images. Never throws.
std::vector<CameraDevice> list_cameras();

/// Returns what a system's error means for a camera and what to do, one line.
std::string camera_error(const std::string& address, int error);

/// Times of a stream's images: as captured by the sender's clock, moved to ours when the stream
/// begins, and again when it jumps back or away from ours.
class CaptureTimes {
 public:
  /// `sender_ns`: the sender's time; nullopt if unknown. Returns a time later than the last one.
  std::int64_t next(std::int64_t arrival_ns, const std::optional<std::int64_t>& sender_ns);

 private:
  static constexpr std::int64_t kMostApart_ns = 5'000'000'000;
  std::int64_t offset_ns_ = 0;  ///< our time - the sender's
  std::optional<std::int64_t> last_sender_ns_;
  std::optional<std::int64_t> last_ns_;
};

}  // namespace gpo
