// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <optional>

namespace gpo {

/// Relative change of the focal length from the first frame of a window to the last.
struct FocalChange {
  double share = 0;        ///< [-]
  double sigma_share = 0;  ///< by noise of the tracks and errors of the lens [-]
};

/// Estimates the change, linear in time, that best reduces the transfer errors of a result's main
/// plane. Normal, motion and, if the result has one, the row delay are further unknowns of one
/// linear step. nullopt if the result failed or does not determine the change.
std::optional<FocalChange> focal_change(const Window& window, const Initialization& result);

}  // namespace gpo
