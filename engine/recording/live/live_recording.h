// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/files/output_file.h"
#include "engine/recording/live/capture.h"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// A camera that is known before its live images are.
struct LiveCamera {
  Camera camera;
  CameraSource source = CameraSource::file;
  std::string detail = {};  ///< for people, see `set_camera`
};

/// Origin of live images.
struct LiveOrigin {
  std::string address;  ///< see `SourceAddress`
  std::string device;   ///< see `OpenSource`
  /// nullopt: guessed. A camera of another size than the images is not used.
  std::optional<LiveCamera> camera = std::nullopt;
};

/// Live images and their times, strictly ascending.
struct LiveImages {
  std::vector<std::int64_t> timestamps_ns;
  std::shared_ptr<const FrameCache> images;
};

/// Layout of live recordings, whose name identifies the camera.
inline constexpr const char* kLiveLayout = "live";

/// Returns live images as a recording without files. There is at least one image.
Recording live_recording(const LiveOrigin& origin, const LiveImages& live);

/// Returns images in memory, CV_8UC3 or CV_8UC1, as those of a recording.
std::shared_ptr<const FrameCache> images_in_memory(std::vector<cv::Mat> images);

/// The images of the last seconds, all of one size, in bounded memory: gray ones with one channel.
class LiveBuffer {
 public:
  LiveBuffer(double seconds, std::size_t most_bytes) : seconds_(seconds), most_bytes_(most_bytes) {}

  /// Drops images that are too old or beyond the memory, but never the new one. An image of another
  /// segment replaces all.
  void add(const LiveImage& image);
  /// Returns the images, preceded by those of `earlier` that are older than all of them.
  LiveImages images(std::span<const LiveImage> earlier = {}) const;
  int count() const { return static_cast<int>(images_.size()); }
  std::size_t bytes() const { return bytes_; }

 private:
  double seconds_;
  std::size_t most_bytes_;
  std::size_t bytes_ = 0;
  std::deque<LiveImage> images_;
};

/// Live images of one size on disk, uncompressed, until they are written in their final format.
class FrameSpool {
 public:
  /// Makes a file beside `output`, which the destructor removes. Throws InputError.
  explicit FrameSpool(const fs::path& output);

  /// Throws InputError if the disk is full.
  void add(const LiveImage& image);
  int count() const { return static_cast<int>(timestamps_ns_.size()); }
  cv::Size size() const { return size_; }
  /// Valid as long as the spool.
  LiveImages images() const;

 private:
  struct File;
  fs::path output_;
  AtomicFile unfinished_;
  std::shared_ptr<File> file_;
  cv::Size size_;
  std::vector<std::int64_t> timestamps_ns_;
};

}  // namespace gpo
