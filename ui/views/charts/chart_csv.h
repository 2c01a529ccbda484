// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/chart.h"

#include <string>

namespace gpo {

/// A line a point: the curve's name, x, y, and where there is one its band. Unknown values are
/// empty; commas of the labels are semicolons.
std::string to_csv(const Chart& chart);

}  // namespace gpo
