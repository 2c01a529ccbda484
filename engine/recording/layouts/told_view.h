// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/camera_source.h"

#include <filesystem>
#include <optional>

namespace gpo {

/// What a video or a picture, as cameras write them, says of how much was seen; nothing where it
/// does not, or cannot be read.
std::optional<ToldView> told_view(const std::filesystem::path& file);

}  // namespace gpo
