// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/benchmark/measure.h"

#include "tests/engine/simulated_window.h"

#include <fmt/format.h>

namespace gpo::bench {

std::vector<Size> sizes_over_frames() {
  return {{5, 150}, {10, 150}, kUsual, {100, 150}, {300, 150}};
}

std::vector<Size> sizes_over_points() { return {{30, 50}, kUsual, {30, 500}, {30, 2000}}; }

std::vector<Size> large_sizes() { return {{100, 500}, {300, 500}, {100, 2000}, {300, 2000}}; }

std::string name_of(const std::string& subject, const Size& size) {
  return fmt::format("{}/{}x{}", subject, size.frames, size.points);
}

const Window& Windows::of(const Size& size, bool biased) {
  const auto [window, first] = windows_.try_emplace({size, biased});
  if (first) {
    test::SimulationOptions options;
    options.frames = size.frames;
    options.points = size.points;
    if (biased) options.gyro_bias_rad_s = options.gyro_noise_rad_s = 0.002;
    window->second = test::with_fitted_homographies(test::simulate(options)).window;
  }
  return window->second;
}

}  // namespace gpo::bench
