// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"
#include "engine/experiment/figure.h"
#include "engine/experiment/row.h"

#include <span>
#include <string>
#include <vector>

namespace gpo {

/// The comparison that a figure shows.
struct FigurePlan {
  std::string name;  ///< of its files
  std::string title;
  std::vector<Configuration> configurations;
};

/// The paper's figures whose titles are true of at least two of the configurations, and one of all
/// configurations where the others leave any out.
std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations);

/// ATE, PNE and PDE over the length of the window: median and quartiles over the windows that all
/// configurations solved (`on_common_windows`), dotted the bound on the normal for the first
/// configuration. `rows` may have others.
Figure figure_over_length(std::span<const Row> rows, const FigurePlan& plan);

/// The same of what an accelerometer tells: the errors of the scale (its size, over the windows
/// that claim to know it) and of gravity. Without charts where nothing is known of them.
Figure figure_of_meters(std::span<const Row> rows, const FigurePlan& plan);

/// The same where no truth is known: the root mean square error in the picture over the length.
Figure figure_without_truth(std::span<const Row> rows, const FigurePlan& plan);

/// All of an experiment's figures.
std::vector<Figure> figures(std::span<const Row> rows,
                            const std::vector<Configuration>& configurations);

}  // namespace gpo
