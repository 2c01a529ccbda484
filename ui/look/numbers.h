// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace gpo {

/// Formats with three significant digits, but at most `most` decimals.
std::string number_text(double value, int most);

std::string two_decimals(const std::optional<double>& value);  ///< "0.25"; a dash if unknown.

std::string length_text(double meters);  ///< "4.1 mm", "1.20 m".
std::string angle_text(double degrees);  ///< "0.31°".
std::string milliseconds_text(double milliseconds);

/// Formats `value` - `reference`, both in the unit of `text`: "+0.12°", "-1.3 mm", "±0".
std::string difference_text(double value, double reference, std::string (*text)(double));

/// "0.912 ±0.004": two significant digits of the standard deviation, at most six decimals.
std::string uncertain_text(double value, double sigma);

}  // namespace gpo
