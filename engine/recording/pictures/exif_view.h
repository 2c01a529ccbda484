// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/camera_source.h"

#include <filesystem>
#include <optional>

namespace gpo {

/// By what a camera wrote into a picture (EXIF): the focal length of film of 35 mm, else its own
/// with the sensor's pixels a length. Nothing where it is not told, or makes no sense.
std::optional<ToldView> view_of_exif(const std::filesystem::path& picture);

}  // namespace gpo
