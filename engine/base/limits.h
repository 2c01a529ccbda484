// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

namespace gpo {

/// Accepted numbers, both ends included; `text` describes them for messages.
struct AcceptedRange {
  double least;
  double most;
  const char* text;
};

// For numbers whose squares and the inverses of these must be finite.
inline constexpr AcceptedRange kAboveZero{1e-9, 1e9, "a finite number above 0"};
inline constexpr AcceptedRange kFromZero{0, 1e9, "a finite number from 0 on"};
inline constexpr AcceptedRange kFinite{-1e9, 1e9, "a finite number"};

/// A number that a caller gives.
struct Limit {
  const char* name;
  double value;
  AcceptedRange range;

  bool holds() const { return value >= range.least && value <= range.most; }
  /// "nan, expected a finite number".
  std::string message() const;
};

/// Throws InputError "OWNER: NAME nan, expected a finite number" for the first number beyond its
/// limits.
void check_limits(const char* owner, std::span<const Limit> limits);
/// Throws SettingError for the first option beyond its limits.
void check_options(std::span<const Limit> limits);

}  // namespace gpo
