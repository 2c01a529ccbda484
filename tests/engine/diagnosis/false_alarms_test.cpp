// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Findings on inputs without any fault.
#include "engine/diagnosis/diagnosis.h"
#include "tests/engine/pipeline/simulated_frames.h"

#include <array>
#include <map>
#include <string>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

TEST(FalseAlarms, AreAtMostOnePercentOf200SimulatedWindows) {
  constexpr int kSeeds = 25, kMost = 2;
  constexpr std::array kFrames{10, 20, 30};
  std::map<std::string, int> alarms;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    for (const Motion motion : kMotions) {
      SimulationOptions options = noisy(motion, static_cast<std::uint64_t>(seed));
      options.frames = kFrames[seed % kFrames.size()];
      options.off_plane = 0.15;
      options.gyro_bias_rad_s = 0.005;
      options.gyro_noise_rad_s = 0.002;
      const Simulation simulation = simulate(options);
      const Gyroscope gyroscope = simulated_gyroscope(options);
      const WindowResult result = initialize(camera_of(simulation.window),
                                             frames_of(simulation.window),
                                             seed % 2 == 0 ? &gyroscope : nullptr);
      for (const Finding& finding : result.findings) ++alarms[finding.key];
    }
  }
  for (const char* key : {"not-finite",
                          "implausible-intrinsics",
                          "static-tracks",
                          "changing-focal-length",
                          "repeated-texture",
                          "camera-at-rest",
                          "gyroscope-bias",
                          "gyroscope-units",
                          "moving-objects",
                          "interlaced"})
    EXPECT_LE(alarms[key], kMost) << key;
}

}  // namespace
}  // namespace gpo::test
