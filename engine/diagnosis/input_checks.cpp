// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/diagnosis/checks.h"

#include <fmt/format.h>

namespace gpo::check {

Findings guessed_camera(const Evidence& e) {
  if (!e.camera_is_guess) return {};
  return {{.level = Level::weak, .sentence = "the camera is a guess", .advice = "calibrate it"}};
}

}  // namespace gpo::check
