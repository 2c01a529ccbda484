// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <string>

namespace gpo {

/// The recording with another camera, and a note on it where no file tells it; `detail` is how it
/// was come by, for people.
void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail);

/// A guess from the size of its pictures, which is known.
void guess_camera(Recording& recording);

}  // namespace gpo
