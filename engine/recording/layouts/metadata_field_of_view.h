// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/camera_source.h"

#include <filesystem>
#include <optional>
#include <string_view>

namespace gpo {

/// What a video or a picture, as cameras write them, says of how much was seen; nothing where it
/// does not, or cannot be read.
std::optional<MetadataFieldOfView> metadata_field_of_view(const std::filesystem::path& file);

/// By what a camera wrote into a picture (EXIF): the focal length of film of 35 mm, else its own
/// with the sensor's pixels a length. Nothing where it is not told, or makes no sense.
std::optional<MetadataFieldOfView> view_of_exif(const std::filesystem::path& image);

/// By the focal length that phones write among a video's metadata. Roughly: that a video is cut out
/// of the picture, to steady it, need not be in it.
std::optional<MetadataFieldOfView> view_of_metadata(const std::filesystem::path& video);

/// By the settings of a GoPro (`gopro_settings`): the angle along the diagonal (ZFOV) of a fisheye,
/// unless the camera has made the pictures linear (VFOV). Nothing where it is not told.
std::optional<MetadataFieldOfView> view_of_gpmf(std::string_view settings);

}  // namespace gpo
