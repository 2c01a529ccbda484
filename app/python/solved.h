// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inertial/inertial_alignment.h"
#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace gpo {

/// What Python's results have in common; whoever owns the parts lives as long.
struct Solved {
  std::shared_ptr<const Initialization> initialization;
  std::shared_ptr<const Window> window;
  std::shared_ptr<const std::vector<std::int64_t>> ids;  ///< of the window's tracks
  std::shared_ptr<const InertialAlignment> inertial;     ///< null: no accelerometer was used

  const Initialization& operator*() const { return *initialization; }
};

}  // namespace gpo
