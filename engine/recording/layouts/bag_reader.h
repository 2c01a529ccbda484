// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/topic_roles.h"
#include "engine/recording/recording.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>

namespace gpo {

/// The path itself, where it is a bag by its name, or a folder with one.
std::optional<std::filesystem::path> find_bag(const std::filesystem::path& path);

/// The one bag at a path that `find_bag` found. Throws InputError where a folder has several.
std::filesystem::path bag_at(const std::filesystem::path& path);

/// Reads a bag of ROS: one topic of pictures, and where there are such topics the calibration, the
/// gyroscope and the truth; beside it camera.yaml, imu.yaml, groundtruth.txt and groundtruth.yaml.
/// Pictures stay in the bag until they are looked at. Throws InputError.
Recording read_bag(const std::filesystem::path& path,
                   const std::optional<std::filesystem::path>& tracks,
                   std::size_t cache_bytes,
                   const TopicChoices& choices);

/// Only the pictures, of whatever size, without a calibration. Throws InputError.
std::shared_ptr<const FrameCache> open_bag_pictures(const std::filesystem::path& path,
                                                    std::size_t cache_bytes,
                                                    const TopicChoices& choices);

}  // namespace gpo
