// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <optional>
#include <string>

namespace gpo {

/// Whether a window is fit to initialize from.
enum class Readiness { ready, weak, degenerate };

template <>
struct ChoiceKeys<Readiness> {
  static constexpr const char* name = "readiness";
  static constexpr std::array keys{"ready", "weak", "degenerate"};
};

/// With the numbers that it rests on; what could not be computed is empty.
struct Verdict {
  Readiness readiness = Readiness::degenerate;
  std::string reason;                         ///< one sentence, for people; with numbers
  std::optional<double> normal_sigma_deg;     ///< of the normal, uncertain rotations marginalized
  std::optional<double> rotation_rms_px;      ///< of the best rotations alone, frame by frame
  std::optional<double> noise_px;             ///< of one coordinate, what the homographies leave
  std::optional<double> largest_translation;  ///< largest |tau| [plane distance]
};

}  // namespace gpo
