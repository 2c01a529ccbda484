// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

namespace gpo {

/// Returns the median difference between successive time stamps; 0 for fewer than two.
std::int64_t median_period_ns(std::span<const std::int64_t> timestamps_ns);

/// Returns 1 / median period, unaffected by gaps [Hz]; 0 for fewer than two time stamps.
double rate_hz(std::span<const std::int64_t> timestamps_ns);

}  // namespace gpo
