// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/camera_source.h"

#include <optional>
#include <string_view>

namespace gpo {

/// By the settings of a GoPro (`gopro_settings`): the angle along the diagonal (ZFOV) of a fisheye,
/// unless the camera has made the pictures linear (VFOV). Nothing where it is not told.
std::optional<ToldView> view_of_gpmf(std::string_view settings);

}  // namespace gpo
