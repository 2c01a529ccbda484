// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace gpo {

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

double quantile(std::span<const double> ascending, double share) {
  const double place = share * static_cast<double>(ascending.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, ascending.size() - 1);
  return std::lerp(ascending[below], ascending[above], place - std::floor(place));
}

std::optional<double> parabola_minimum(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  if (!(bend > 0)) return std::nullopt;
  return 0.5 * (before - after) / bend;
}

std::array<double, 2> middle_range(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t cut = values.size() / 25;
  return {values[cut], values[values.size() - 1 - cut]};
}

double sum_of_squares(std::span<const double> values) {
  return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

double root_mean_square(std::span<const double> values) {
  return values.empty() ? 0
                        : std::sqrt(sum_of_squares(values) / static_cast<double>(values.size()));
}

double without_negative_zero(double value, int decimals) {
  return value <= 0 && value >= -0.5 * std::pow(10, -decimals) ? 0 : value;
}

}  // namespace gpo
