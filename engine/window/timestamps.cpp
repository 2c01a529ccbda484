// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/timestamps.h"

#include <algorithm>
#include <vector>

namespace gpo {

std::int64_t median_period_ns(std::span<const std::int64_t> timestamps_ns) {
  if (timestamps_ns.size() < 2) return 0;
  std::vector<std::int64_t> periods;
  for (std::size_t i = 1; i < timestamps_ns.size(); ++i) {
    periods.push_back(timestamps_ns[i] - timestamps_ns[i - 1]);
  }
  const auto middle = periods.begin() + static_cast<std::ptrdiff_t>(periods.size() / 2);
  std::nth_element(periods.begin(), middle, periods.end());
  return *middle;
}

double rate_hz(std::span<const std::int64_t> timestamps_ns) {
  const std::int64_t period_ns = median_period_ns(timestamps_ns);
  return period_ns > 0 ? 1e9 / static_cast<double>(period_ns) : 0;
}

}  // namespace gpo
