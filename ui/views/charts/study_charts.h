// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/studies/track_life.h"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Lengths of the inliers' residuals [px] by frame of the window, zero in the reference frame.
/// Empty if the initialization failed.
using WindowResiduals = std::vector<std::vector<double>>;
WindowResiduals window_residuals(const Inspection& inspection);

/// Returns histograms of the residuals of the window and of a frame (counted in the recording) [%].
Chart residual_histogram(const WindowResiduals& residuals, const Inspection& inspection, int frame);

/// Returns the RMS residual over the frames, and the residuals of a track (null: none).
Chart rms_chart(const WindowResiduals& residuals,
                const Inspection& inspection,
                const TrackLife* track);

struct SolverRun {
  std::string name;
  std::uint32_t rgb;
  const SolverReport* report;
};

/// Returns cost, gradient and step over the iterations of the runs with a trace.
std::array<Chart, 3> solver_charts(std::span<const SolverRun> runs);

}  // namespace gpo
