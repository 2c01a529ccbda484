// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/window/gyroscope.h"

#include <filesystem>
#include <optional>
#include <vector>

namespace gpo {

/// What a window was made of. No method of ours asks for it; a user's own may. Null or empty: there
/// is none.
struct Sources {
  const Camera* camera = nullptr;          ///< of the raw pictures
  const Gyroscope* gyroscope = nullptr;    ///< of the whole recording
  std::optional<Pose> T_body_camera = {};  ///< body: the axes of the IMU; where it is told
  /// A video of the whole recording, or one picture a frame of the window.
  std::vector<std::filesystem::path> images = {};
};

}  // namespace gpo
