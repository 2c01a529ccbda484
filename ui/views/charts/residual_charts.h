// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/track_life.h"

#include <vector>

namespace gpo {

/// Lengths of the inliers' residuals [px], one list a frame of the window; of the reference frame,
/// from which the others are predicted, they are zero. Empty where the initialization failed.
using WindowResiduals = std::vector<std::vector<double>>;
WindowResiduals window_residuals(const Inspection& inspection);

/// How the residuals of the whole window are distributed, the reference frame aside, and over it
/// those of one frame, which counts in the recording; each in percent of its own. The last bin
/// holds what is beyond it, too.
Chart residual_histogram(const WindowResiduals& residuals, const Inspection& inspection, int frame);

/// Their root mean square over the frames of the recording, and a track's own residuals (null:
/// none).
Chart rms_chart(const WindowResiduals& residuals,
                const Inspection& inspection,
                const TrackLife* track);

}  // namespace gpo
