// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// Throws InputError where a picture has not the size that the camera was calibrated for; any size
/// passes where that is 0x0, not known.
void check_size(const std::filesystem::path& file, cv::Size size, const Camera& camera);

/// Opens at least one file as the recording's pictures. The first decides how many bits are
/// significant, and the camera's size where the calibration does not tell it. Throws InputError.
void add_image_files(Recording& recording,
                       std::vector<std::filesystem::path> files,
                       std::size_t cache_bytes);

/// Numbered pictures of a folder in the order of their numbers: 2.png before 10.png.
std::vector<std::filesystem::path> numbered_images(const std::filesystem::path& folder);

}  // namespace gpo
