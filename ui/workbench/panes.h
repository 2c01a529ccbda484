// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

namespace gpo {

/// What stands beside the picture.
enum class SidePane { scene, normals, solver, candidates };

template <>
struct ChoiceKeys<SidePane> {
  static constexpr const char* name = "view";
  static constexpr std::array keys{"scene", "normals", "solver", "candidates"};
};

/// What is drawn out below picture and side pane.
enum class Drawer { curves, table, residuals, timing, track, log };

template <>
struct ChoiceKeys<Drawer> {
  static constexpr const char* name = "view";
  static constexpr std::array keys{"curves", "table", "residuals", "timing", "track", "log"};
};

}  // namespace gpo
