// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"
#include "engine/experiment/configuration.h"
#include "engine/experiment/row.h"

#include <span>
#include <string>
#include <vector>

namespace gpo {

/// Returns ATE, PNE and PDE over the window length: median and quartiles over the windows that all
/// configurations solved (`on_common_windows`), and dotted the bound of the normal for the first
/// configuration. Ignores rows of other configurations.
Figure figure_over_length(std::span<const Row> rows, const FigurePlan& plan);

/// Returns the reprojection RMS over the length, for recordings without ground truth.
Figure figure_without_truth(std::span<const Row> rows, const FigurePlan& plan);

/// Returns all figures of an experiment, also those of metric scale and gravity if an accelerometer
/// was used.
std::vector<Figure> figures(std::span<const Row> rows,
                            const std::vector<Configuration>& configurations);

}  // namespace gpo
