// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/recording/recording.h"

#include <string>

namespace gpo {

/// Who says what a recording's camera is like.
enum class CameraSource { file, self_calibrated, guess };

template <>
struct ChoiceKeys<CameraSource> {
  static constexpr const char* name = "camera source";
  static constexpr std::array keys{"file", "self-calibrated", "guess"};
};

/// As the recording's notes tell it: where no file says what the camera is, one does.
CameraSource camera_source(const Recording& recording);

/// The recording without the notes on its camera, with another camera from there; `detail` is how
/// it was come by, for people.
void set_camera(Recording& recording,
                const Camera& camera,
                CameraSource source,
                const std::string& detail);

}  // namespace gpo
