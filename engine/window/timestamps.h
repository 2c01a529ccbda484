// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

namespace gpo {

/// Median of the differences between successive time stamps; 0 for fewer than two.
std::int64_t median_period_ns(std::span<const std::int64_t> timestamps_ns);

/// 1 / median period [Hz], whatever gaps there are; 0 for fewer than two time stamps.
double rate_hz(std::span<const std::int64_t> timestamps_ns);

}  // namespace gpo
