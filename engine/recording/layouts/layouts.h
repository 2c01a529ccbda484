// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/topic_roles.h"
#include "engine/recording/recording.h"
#include "engine/window/tracks.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace gpo {

struct OpenOptions {
  std::optional<std::filesystem::path> tracks;  ///< replaces the built-in tracker
  std::size_t cache_bytes = FrameCache::kDefaultByteLimit;
  /// Where what was found in the pictures is kept for the next time; empty: nowhere.
  std::filesystem::path cache_folder{};
  TopicChoices topics{};  ///< of a bag
};

/// One way in which recordings are stored.
struct Layout {
  const char* title = "";     ///< for people: "EuRoC"
  const char* expected = "";  ///< by what it is recognized, in a list: "cam0/data.csv (EuRoC)"
  const char* file = "";  ///< the name of a file in it that stands for the folder; empty: none does
  /// What `read` wants, where the path (a folder, or one file) has this layout.
  std::optional<std::filesystem::path> (*find)(const std::filesystem::path& path);
  /// Whether it has pictures, so that tracks beside them are not wanted unless asked for.
  bool (*has_images)(const std::filesystem::path& found);
  /// Throws InputError. With tracks pictures may be missing.
  Recording (*read)(const std::filesystem::path& found, const OpenOptions& options);
  bool has_topics = false;    ///< to choose from
  bool tracks_alone = false;  ///< a folder that has tracks and no other layout
};

/// All of them, in the order in which they are tried.
std::span<const Layout> layouts();

/// What a folder or a file is, as far as its list of frames tells: no picture is decoded, no truth
/// computed.
struct PathProbe {
  std::string layout;  ///< "EuRoC"; empty: no recording
  int frames = 0;      ///< 0: cannot be told
  double seconds = 0;
};

/// Never throws: what cannot be read has no frames.
PathProbe probe_path(const std::filesystem::path& path);

// The layouts' readers, each with what finds it. All throw InputError.

/// The folder that holds cam0: this one, or mav0 in it.
std::optional<std::filesystem::path> find_euroc(const std::filesystem::path& folder);
/// The EuRoC / ASL layout, from the folder that holds cam0. Where any picture is missing, there are
/// none.
Recording read_euroc(const std::filesystem::path& folder, const OpenOptions& options);
/// Whether none of the pictures that cam0/data.csv lists exists.
bool euroc_lacks_images(const std::filesystem::path& folder);

/// The folder, where it holds rgb.txt.
std::optional<std::filesystem::path> find_tum(const std::filesystem::path& folder);
/// The layout of the TUM RGB-D benchmark: rgb.txt, the pictures that it lists, groundtruth.txt (the
/// camera's poses) and a calibration beside them; depth is passed over.
Recording read_tum(const std::filesystem::path& folder, const OpenOptions& options);

/// The path itself, where it is a video or a folder with a video or with numbered pictures.
std::optional<std::filesystem::path> find_images(const std::filesystem::path& path);
/// A video, or a folder with a video or with numbered pictures (in it, or in its folder images,
/// frames, rgb or data), and beside them a calibration, gyro.csv or gyro_accel.csv,
/// frame_timestamps.txt and groundtruth.txt. With tracks there need be no pictures; without, no
/// calibration: the camera is a guess then (camera_source.h).
Recording read_images(const std::filesystem::path& path, const OpenOptions& options);
/// Only the pictures of a video, of a folder with one or with numbered pictures, or of any layout's
/// folder, or of a bag; of whatever size, without a calibration.
std::shared_ptr<const FrameCache> open_images(const std::filesystem::path& path,
                                                std::size_t cache_bytes,
                                                const TopicChoices& topics = {});

/// The path itself, where it is a bag by its name, or a folder with one.
std::optional<std::filesystem::path> find_bag(const std::filesystem::path& path);
/// The one bag at a path that `find_bag` found; a folder may have several, which is refused.
std::filesystem::path bag_at(const std::filesystem::path& path);
/// A bag of ROS: one topic of pictures, and where there are such topics the calibration, the
/// gyroscope and the truth; beside it camera.yaml, imu.yaml, groundtruth.txt and groundtruth.yaml.
/// Pictures stay in the bag until they are looked at.
Recording read_bag(const std::filesystem::path& path, const OpenOptions& options);
/// Only the pictures, of whatever size, without a calibration.
std::shared_ptr<const FrameCache> open_bag_images(const std::filesystem::path& path,
                                                    std::size_t cache_bytes,
                                                    const TopicChoices& choices);

/// tracks.csv (`frame,track,x,y`, raw pixels, then what you like), sorted by frame, then track. A
/// frame must be below `frame_count` where that is known.
std::vector<TrackObservation> read_tracks(const std::filesystem::path& file,
                                          std::optional<int> frame_count);

}  // namespace gpo
