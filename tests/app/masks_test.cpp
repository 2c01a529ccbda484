// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/text_file.h"
#include "tests/app/program.h"

#include <algorithm>

#include <gmock/gmock.h>

namespace gpo::test {
namespace {

TEST(RunWithMasks, LeavesOutTracksInMasks) {
  const json whole = run_json(kDesk), masked = run_json("{} --mask not:0,0,300,479", kDesk);
  EXPECT_LT(masked["points"].size(), whole["points"].size());
  EXPECT_EQ(masked["settings"]["mask"][0]["kind"], "not");
  EXPECT_FALSE(whole["settings"].contains("mask"));
}

TEST(RunWithMasks, CountsOnlyTheTracksOutsideOfMasks) {
  const auto tracks = [](const char* options) {
    const std::string text = succeeding("run {} --frames 12 {}", kDesk, options).out;
    return std::stoi(*matches_in(text, R"(inliers +\d+ of (\d+))", 1).begin());
  };
  EXPECT_LT(tracks("--mask not:0,0,300,479"), tracks(""));
}

TEST(RunWithMasks, ExtrapolatesCamerasAfterTheWindowOnRequestOnly) {
  const fs::path folder = fresh_folder();
  const json result =
      run_json("{} --frames 20 --extrapolate 5 --trajectory {}", kDesk, folder / "a.tum");
  ASSERT_EQ(result["extrapolated"]["frames"].size(), 5U) << result["extrapolated"]["end"];
  EXPECT_EQ(result["extrapolated"]["frames"][0]["index"], 20);
  EXPECT_EQ(result["frames"].size(), 20U);
  run_json("{} --frames 20 --extrapolate 5 --extrapolated-trajectory --trajectory {}",
           kDesk,
           folder / "b.tum");
  const std::string shorter = read_file(folder / "a.tum"), longer = read_file(folder / "b.tum");
  EXPECT_EQ(std::ranges::count(longer, '\n'), std::ranges::count(shorter, '\n') + 5);
  EXPECT_FALSE(run_json("{} --frames 20", kDesk).contains("extrapolated"));
}

}  // namespace
}  // namespace gpo::test
