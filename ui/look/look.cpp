// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/look/look.h"

#include "engine/geometry/statistics.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {

std::string number_text(double value, int most) {
  if (!std::isfinite(value)) return "\u2013";
  const double size = std::abs(value);
  const int decimals = size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3;
  const int shown = std::min(decimals, most);
  return fmt::format("{:.{}f}", without_negative_zero(value, shown), shown);
}

std::string two_decimals(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.2f}", *value) : "\u2013";
}

std::string length_text(double meters) {
  if (std::abs(meters) >= 1) return number_text(meters, 3) + " m";
  return number_text(meters * 1e3, 2) + " mm";
}

std::string angle_text(double degrees) { return number_text(degrees, 3) + "\u00b0"; }

std::string sigma_text(double degrees) {
  return degrees <= 90 ? "\u00b1" + angle_text(degrees) : "undetermined";  // NaN, too
}

std::string milliseconds_text(double milliseconds) {
  return number_text(milliseconds, milliseconds < 1 ? 2 : 1) + " ms";
}

std::string difference_text(double value, double reference, std::string (*text)(double)) {
  const double difference = value - reference;
  const std::string size = text(std::abs(difference));
  if (size.find_first_of("123456789") == std::string::npos) return "\u00b10";
  return (difference < 0 ? "\u2212" : "+") + size;
}

std::string uncertain_text(double value, double sigma) {
  if (!std::isfinite(value) || !std::isfinite(sigma))
    return number_text(value, 3) + " \u00b1\u2013";
  constexpr int kMost = 6;
  const int decimals =
      sigma > 0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, kMost) : kMost;
  return fmt::format("{:.{}f} \u00b1{:.{}f}", value, decimals, sigma, decimals);
}

}  // namespace gpo
