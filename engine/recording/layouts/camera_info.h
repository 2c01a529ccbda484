// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/recording/bags/messages.h"

#include <string>

namespace gpo {

/// Whether somebody calibrated it: ROS' drivers send zeros otherwise.
bool is_calibrated(const CameraInfoMessage& info);

/// Throws InputError that begins with `name` where it is no camera that we know.
Camera camera_of(const CameraInfoMessage& info, const std::string& name);

/// What `camera_of` reads; without its header.
CameraInfoMessage camera_info_of(const Camera& camera);

}  // namespace gpo
