// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/bags/topic_roles.h"
#include "engine/recording/recording.h"

#include <filesystem>

namespace gpo {

/// Reads a video, or a folder with a video or with numbered pictures (in it, or in its folder
/// images, frames, rgb or data), and beside them a calibration, gyro.csv or gyro_accel.csv,
/// frame_timestamps.txt and groundtruth.txt. With `tracks` there need be no pictures; without, no
/// calibration: the camera is a guess then (camera_source.h). Throws InputError.
Recording read_pictures(const std::filesystem::path& path,
                        const std::optional<std::filesystem::path>& tracks,
                        std::size_t cache_bytes);

/// Only the pictures of a video, of a folder with one or with numbered pictures, or of any layout's
/// folder, or of a bag; of whatever size, without a calibration. Throws InputError where there are
/// none.
std::shared_ptr<const FrameCache> open_pictures(const std::filesystem::path& path,
                                                std::size_t cache_bytes,
                                                const TopicChoices& topics = {});

/// The path itself, where it is a video or a folder with a video or with numbered pictures.
std::optional<std::filesystem::path> find_pictures(const std::filesystem::path& path);

}  // namespace gpo
