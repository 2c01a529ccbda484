// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace gpo {

/// Median length of a two-dimensional Gaussian vector [standard deviations of a coordinate].
inline constexpr double kMedianOfRayleigh = 1.1774;

/// Returns the upper median of at least one value.
double median(std::vector<double> values);

/// Returns a quantile of at least one ascending value, linearly interpolated; `share` from 0 to 1.
double quantile(std::span<const double> ascending, double share);

/// Returns the least and the largest of the values without 4 % at each end; at least one value.
std::array<double, 2> middle_range(std::vector<double> values);

double sum_of_squares(std::span<const double> values);

/// Returns the root mean square; 0 for no values.
double root_mean_square(std::span<const double> values);

/// Returns the weight of Huber's loss relative to that of the squared one. `knee` has the unit of
/// `length`.
inline double huber_weight(double length, double knee) { return length > knee ? knee / length : 1; }

/// Returns where the parabola through values at -1, 0 and 1 has its minimum; nullopt if it has
/// none.
std::optional<double> parabola_minimum(double before, double middle, double after);

/// Returns 0 for a negative value that would be printed as -0 with these decimals, else the value.
double without_negative_zero(double value, int decimals);

}  // namespace gpo
