// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/recording/frame_cache.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <vector>

#include <opencv2/core.hpp>

namespace gpo {

/// Decodes a picture file to BGR, 8 bits. Throws InputError where it is missing, cut or broken; a
/// half picture is never returned.
cv::Mat read_picture(const std::filesystem::path& file);

/// Throws InputError where the picture has not the size that the camera was calibrated for; a width
/// of 0 means that it was not, and any will do.
void check_size(const std::filesystem::path& file, const cv::Mat& picture, const Camera& camera);

std::shared_ptr<const FrameCache> open_picture_files(std::vector<std::filesystem::path> files,
                                                     const Camera& camera,
                                                     std::size_t cache_bytes);

/// Whether the file's name ends like that of a picture (png, jpg, ...).
bool is_picture_name(const std::filesystem::path& file);

/// Numbered pictures of a folder in the order of their numbers: 2.png before 10.png.
std::vector<std::filesystem::path> numbered_pictures(const std::filesystem::path& folder);

}  // namespace gpo
