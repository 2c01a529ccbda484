// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <functional>
#include <optional>
#include <vector>

namespace gpo {

inline constexpr int kJackknifeGroups = 10;

/// Returns the window without the tracks that are marked, one per track. Homographies are fitted
/// again; moves by the lens and the row delay are dropped.
Window without_tracks(const Window& window, const std::vector<bool>& removed);

/// Returns the covariances of a method's own estimates (engine/method.md, eq. 14j): tracks are
/// split into `kJackknifeGroups` regions of the reference image, and `initialize` runs without each
/// of them. `result` is that of all tracks. nullopt if there are too few tracks; only `unstable` if
/// half of the runs fail or end in another minimum.
std::optional<NoiseSpread> jackknife(
    const Window& window,
    const Initialization& result,
    const std::function<Initialization(const Window& without_group)>& initialize);

/// Returns the uncertainty with the method's own noise in place of the window's. Other
/// contributions (rotations, lens, bend) stay. The joint covariance keeps its correlations.
Uncertainty with_own_noise(Uncertainty u, const Plane& plane, const NoiseSpread& own);

}  // namespace gpo
