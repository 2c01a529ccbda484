// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <iterator>

#include <Eigen/Core>

namespace gpo {

/// Generator with the same numbers on every platform (SplitMix64), unlike the standard library's
/// distributions. Each `stream` of a seed is independent: a frame, a row, a print. Draw one number
/// per statement, since the evaluation order of arguments is up to the compiler.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);
  std::uint64_t bits();
  double uniform(double low = 0, double high = 1);  ///< [low, high)
  int below(int n);                                 ///< 0 .. n - 1
  double normal();                                  ///< mean 0, standard deviation 1
  const auto& pick(const auto& all) { return all[below(static_cast<int>(std::size(all)))]; }

 private:
  std::uint64_t state_;
};

/// Smooth noise in [0, 1] with a mean of about 0.5: features of size 1, 1/2, 1/4 ... weighted by
/// their size.
double fractal_noise(double x, double y, int octaves, std::uint64_t seed);
double fractal_noise(const Eigen::Vector3d& place, int octaves, std::uint64_t seed);

}  // namespace gpo
