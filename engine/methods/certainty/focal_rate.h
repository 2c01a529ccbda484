// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <optional>

namespace gpo {

/// Relative change of the focal length per time: f(t) = f (1 + rate t) from the reference frame on.
struct FocalRate {
  double rate_s = 0;   ///< [1/s]
  double sigma_s = 0;  ///< standard deviation by single tracks [1/s]
};

/// Estimates the rate that reduces the errors of a result most, in one linear step with poses and
/// normal as further unknowns. nullopt if the result failed or does not determine it.
std::optional<FocalRate> focal_rate(const Window& window, const Initialization& result);

}  // namespace gpo
