// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <compare>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gpo::bench {

/// Of a simulated window.
struct Size {
  int frames;
  int points;

  auto operator<=>(const Size&) const = default;
  int observations() const { return (frames - 1) * points; }
};

inline constexpr Size kUsual{30, 150};
inline constexpr int kUsualRepetitions = 15;
inline constexpr int kRepetitions = 3;    ///< of everything else
inline constexpr double kLeast_s = 0.02;  ///< of a repetition [s]

std::vector<Size> sizes_over_frames();
std::vector<Size> sizes_over_points();
/// Beyond what is measured of every method.
std::vector<Size> large_sizes();

/// "gpo/30x150": the benchmark of what on which window.
std::string name_of(const std::string& what, const Size& size);

/// Simulated once, when first asked for: 0.5 px noise, homographies fitted.
class Windows {
 public:
  /// `biased`: with rotations from a gyroscope whose bias is not known; else true rotations.
  const Window& of(const Size& size, bool biased = false);

 private:
  std::map<std::pair<Size, bool>, Window> windows_;
};
using SharedWindows = std::shared_ptr<Windows>;

}  // namespace gpo::bench
