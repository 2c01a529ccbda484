// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/methods/common/initialization.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gpo {

/// What a user's own method made of a window, in a world and a scale of its choice.
struct Answer {
  std::optional<std::string> failed;         ///< why; then nothing else is there
  std::vector<std::optional<Pose>> cameras;  ///< one a frame; the first one is there
  std::optional<Plane> plane;                ///< unit normal
  std::vector<PlaneEstimate> planes;         ///< each of the window's planes at most once
  std::vector<MapPoint> points;              ///< each track at most once
  std::optional<double> milliseconds;        ///< that it says it took
};

/// What an answer must fit.
struct Asked {
  int id = 0;  ///< of the question; an answer may repeat it
  int frames = 0;
  int tracks = 0;
  int planes = 0;
};

/// Reads a line as `method_answer.schema.json` has it. Throws InputError that names the key:
/// "cameras[3].R_wc: expected 9 numbers".
Answer read_answer(std::string_view line, const Asked& asked);

}  // namespace gpo
