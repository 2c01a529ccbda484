// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/initialize.h"
#include "tests/engine/pipeline/simulated_frames.h"
#include "tests/engine/simulated_window.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace gpo::test {
namespace {

Simulation window_of_seed(int seed) {
  return simulate({.motion = kMotions[seed % std::size(kMotions)],
                   .off_plane = 0.1,
                   .reference_noise_px = 0.5,
                   .seed = static_cast<std::uint64_t>(seed)});
}

/// Initializes from the same tracks in an image of `scale` times the pixels.
WindowResult scaled_result(const Simulation& s, double scale, const std::string& method) {
  const auto along = [&](double px) { return scale * (px + 0.5) - 0.5; };
  const Camera camera{.width = static_cast<int>(640 * scale),
                      .height = static_cast<int>(480 * scale),
                      .fx = 500 * scale,
                      .fy = 500 * scale,
                      .cx = along(319.5),
                      .cy = along(239.5)};
  std::vector<Frame> frames = frames_of(s.window);
  for (int i = 0; i < s.window.frame_count(); ++i) {
    frames[i].raw_px = frames[i].raw_px.unaryExpr(along).eval();
    frames[i].R_wc = s.window.R_wc[i];
  }
  return initialize(camera, frames, nullptr, {.method = method, .lens = Lens::exact});
}

struct ScaledMethod {
  std::string key;
  int windows;
};

class PixelScale : public testing::TestWithParam<ScaledMethod> {};

TEST_P(PixelScale, VerdictsAndNormalsStayIfPixelsAndNoiseAreScaled) {
  const auto& [method, windows] = GetParam();
  int ready = 0, changed = 0;
  std::vector<double> turned_sigmas;
  for (int seed = 1; seed <= windows; ++seed) {
    const Simulation s = window_of_seed(seed);
    const WindowResult one = scaled_result(s, 1, method);
    ready += one.is_ready() ? 1 : 0;
    for (const double scale : {0.5, 4.0}) {
      const WindowResult other = scaled_result(s, scale, method);
      changed += other.is_ready() == one.is_ready() ? 0 : 1;
      if (!one.is_ready() || !other.is_ready()) continue;
      const Initialization& expected = one.initialization;
      turned_sigmas.push_back(angle_deg(other.initialization.plane.normal, expected.plane.normal) /
                              expected.uncertainty->normal_sigma_deg);
    }
  }
  EXPECT_GE(ready, windows / 2);
  EXPECT_LE(changed, windows / 15);  // there are twice as many pairs
  EXPECT_LT(median(turned_sigmas), 0.2);
}

INSTANTIATE_TEST_SUITE_P(Methods,
                         PixelScale,
                         testing::Values(ScaledMethod{"gpo_joint", 30},
                                         ScaledMethod{"gpo", 30},
                                         ScaledMethod{"pnp", 15},
                                         ScaledMethod{"ba", 15}),
                         [](const auto& info) { return info.param.key; });

}  // namespace
}  // namespace gpo::test
