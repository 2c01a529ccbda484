// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace gpo {

/// The upper median; of at least one value.
double median(std::vector<double> values);

}  // namespace gpo
