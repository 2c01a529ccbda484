// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/experiment/configuration.h"

#include <string>
#include <vector>

namespace gpo {

/// What a figure compares.
struct FigurePlan {
  std::string name;  ///< of its files
  std::string title;
  std::vector<Configuration> configurations;
};

/// The paper's figures whose titles are true of at least two of the configurations, and one of all
/// configurations where the others leave any out.
std::vector<FigurePlan> figure_plans(const std::vector<Configuration>& configurations);

}  // namespace gpo
