// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/rolling_camera.h"
#include "engine/inspection/inspection.h"

#include <optional>

namespace gpo {

/// Returns the camera's readout time, else that estimated from a board's corners; nullopt if
/// unknown.
std::optional<Readout> readout_of_truth(const Inspection& inspection);

/// Returns the estimated camera of a frame; its rows are read one after the other if the result has
/// a row delay. The initialization is ok.
RollingCamera rolling_camera(const Inspection& inspection, int frame);
/// Returns the same with the row delay of `readout_of_truth`, if known. The unit of its motion is
/// that of the truth, which must be known.
RollingCamera true_rolling_camera(const Inspection& inspection, int frame);

}  // namespace gpo
