// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// Beyond this, coordinates are no result.
inline constexpr double kLargestCoordinate = 1e12;

}  // namespace gpo
