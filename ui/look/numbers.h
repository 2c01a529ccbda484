// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace gpo {

/// Three significant digits, but none beyond `most` behind the point.
std::string number_text(double value, int most);

/// "0.25"; a dash where it is not known.
std::string two_decimals(const std::optional<double>& value);

/// "4.1 mm", "1.20 m".
std::string length_text(double meters);
/// "0.31°".
std::string angle_text(double degrees);
std::string milliseconds_text(double milliseconds);

/// "+0.12°", "-1.3 mm": from a reference to a value, both in the unit of `text`; "±0" where the
/// difference does not show.
std::string difference_text(double value, double reference, std::string (*text)(double));

/// "0.912 ±0.004": a value with as many digits as two of its standard deviation say, at most
/// six behind the point.
std::string uncertain_text(double value, double sigma);

}  // namespace gpo
