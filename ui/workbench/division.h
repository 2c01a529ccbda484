// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <array>

namespace gpo {

/// A part that may have the whole window.
enum class WindowPart { none, image, side, drawer };

template <>
struct ChoiceKeys<WindowPart> {
  static constexpr const char* name = "part";
  static constexpr std::array keys{"none", "picture", "side", "drawer"};
};

/// How the user has shared out the window; 0: as it comes. Lengths are of a scale of 1 [px].
struct Division {
  double column_px = 0;      ///< width of the left column
  double settings_px = 0;    ///< height of its upper part
  double image_share = 0;  ///< of the views' width, or of their height where it stands above
  double drawer_share = 0;   ///< of the views' height
  bool column = true;        ///< shown
  bool timeline = true;      ///< shown
  WindowPart maximized = WindowPart::none;

  bool operator==(const Division&) const = default;
};

}  // namespace gpo
