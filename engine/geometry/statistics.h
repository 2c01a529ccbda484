// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

namespace gpo {

/// Median length of a two-dimensional Gaussian, in standard deviations of a coordinate (Rayleigh).
inline constexpr double kMedianOfRayleigh = 1.1774;

/// The upper median; of at least one value.
double median(std::vector<double> values);

/// Interpolated between the two nearest of at least one ascending value, `share` from 0 to 1.
double quantile(std::span<const double> ascending, double share);

double sum_of_squares(std::span<const double> values);

/// Root mean square, 0 of nothing.
double root_mean_square(std::span<const double> values);

}  // namespace gpo
