// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Standard deviations of a calibration, compared with how much halves of real images disagree.
#include "engine/calibration/calibrate.h"
#include "engine/recording/layouts/open_recording.h"

#include <array>
#include <cmath>
#include <cstdlib>

#include <gmock/gmock.h>

namespace gpo {
namespace {

class HeldOutHalves : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Recordings,
                         HeldOutHalves,
                         testing::Values("chessboard-floor", "chessboard-dark"));

TEST_P(HeldOutHalves, DisagreeByLessThanThreeStandardDeviations) {
  const auto folder = std::filesystem::path(GPO_SHARED_DIR) / "data" / GetParam();
  if (std::getenv("GPO_ALL_RECORDINGS") == nullptr) GTEST_SKIP() << "slow; see tests/nightly.sh";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no recordings in " << GPO_SHARED_DIR;
  constexpr int kMostFrames = 160, kBlocks = 12;
  const auto recording = open_recording(folder);
  const Board& board = recording->board.value();
  const BoardSearch all = find_calibration_views(*recording->images, board, kMostFrames);
  std::array<BoardSearch, 2> halves;
  for (std::size_t i = 0; i < all.views.size(); ++i) {
    BoardSearch& half = halves[i * kBlocks / all.views.size() % 2];
    half.size = all.size;
    half.examined += 1;
    half.views.push_back(all.views[i]);
  }
  const CameraCalibration a = calibrate_camera(halves[0], board);
  const CameraCalibration b = calibrate_camera(halves[1], board);
  if (!a.ok || !b.ok) {
    // A refused half claims nothing; then the whole must say how little it knows.
    EXPECT_THAT(a.reason + b.reason, testing::HasSubstr("film the board from more sides"));
    const CameraCalibration whole = calibrate_camera(all, board);
    ASSERT_TRUE(whole.ok) << whole.reason;
    constexpr int kCx = 2;
    EXPECT_GT(whole.camera.sigmas[kCx], 0.02 * whole.camera.cx);
    return;
  }
  const auto of_a = parameters(a.camera), of_b = parameters(b.camera);
  for (std::size_t k = 0; k < 2; ++k)  // fx, fy
    EXPECT_LT(std::abs(of_a[k] - of_b[k]), 3 * std::hypot(a.camera.sigmas[k], b.camera.sigmas[k]))
        << parameter_names(a.camera)[k];
}

}  // namespace
}  // namespace gpo
