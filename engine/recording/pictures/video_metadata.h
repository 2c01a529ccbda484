// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/camera_source.h"

#include <filesystem>
#include <optional>

namespace gpo {

/// By the focal length that phones write among a video's metadata. Roughly: that a video is cut out
/// of the picture, to steady it, need not be in it.
std::optional<ToldView> view_of_metadata(const std::filesystem::path& video);

}  // namespace gpo
