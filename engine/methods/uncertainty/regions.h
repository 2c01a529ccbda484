// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/window.h"

#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

namespace gpo {

/// Regions of the reference image, three columns of three, with equal numbers of tracks.
inline constexpr int kRegions = 9;

/// Returns the window without the tracks that are marked, one per track. Homographies are fitted
/// again; moves by the lens and the row delay are dropped.
Window without_tracks(const Window& window, const std::vector<bool>& removed);

/// Returns the covariances of a method's own estimates by a jackknife (engine/method.md, eq. 14j):
/// `initialize` runs without the tracks of each region, on several threads. `result` is that of all
/// tracks. nullopt if there are too few tracks or a run was stopped; only `unstable` if half of the
/// runs fail or end in another minimum.
std::optional<NoiseSpread> spread_by_regions(
    const Window& window,
    const Initialization& result,
    const std::function<Initialization(const Window& without_region)>& initialize);

/// Returns the uncertainty with another size for the contribution of the tracks' noise
/// (engine/method.md, eq. 14k): for the normal the largest of the analytic one, that of the regions
/// and the bend of the surface (`Uncertainty::bend_sigma_deg`), with three quarters of its shape
/// by the regions. Centers, further planes, bias, clock, row delay and rotations keep their shapes
/// and widen as the normal does, up to their priors; centers at least as the regions tell.
/// Contributions that no choice of tracks changes (gyroscope, lens, readout) stay. So does the
/// joint covariance of a method with an own uncertainty: gravity and scale weigh the poses by it,
/// and with a wider one accelerations would move them off the tracks. That of the others keeps its
/// correlations.
Uncertainty with_size(Uncertainty u,
                      const Window& window,
                      const Plane& plane,
                      const std::optional<NoiseSpread>& by_regions);

}  // namespace gpo
