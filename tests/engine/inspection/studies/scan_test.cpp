// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/scan.h"

#include "engine/inspection/inspector.h"
#include "tests/engine/desk.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::desk;

TEST(StartsToScan, AreMultiplesOfTheStepFromCoarseToFine) {
  for (const auto& [recorded, frames, step] :
       {std::tuple{60, 30, 1}, {60, 60, 1}, {31, 30, 7}, {1000, 20, 13}, {257, 1, 1}}) {
    const auto starts = starts_to_scan(recorded, frames, step);
    const std::set<int> once(starts.begin(), starts.end());
    EXPECT_EQ(once.size(), starts.size());
    for (int start = 0; start + frames <= recorded; start += step)
      EXPECT_TRUE(once.contains(start)) << start;
    EXPECT_EQ(once.size(), static_cast<std::size_t>((recorded - frames) / step + 1));
    // The gap between neighbors halves as their number doubles.
    for (std::size_t count = 4; count < starts.size(); count *= 2) {
      std::set<int> first(starts.begin(), starts.begin() + static_cast<std::ptrdiff_t>(count));
      int gap = 0;
      for (auto at = first.begin(); std::next(at) != first.end(); ++at)
        gap = std::max(gap, *std::next(at) - *at);
      EXPECT_LE(gap, 4 * (recorded - frames) / static_cast<int>(count) + step);
    }
  }
  EXPECT_TRUE(starts_to_scan(20, 30, 1).empty());
  EXPECT_EQ(scan_step(60, 30), 1);
  EXPECT_LE(starts_to_scan(100'000, 30, scan_step(100'000, 30)).size(), 101U);
}

TEST(ScanStarts, MatchSingleInspections) {
  const Settings settings{.frames = 20};
  const std::vector<int> starts = starts_to_scan(desk()->frame_count(), 20, 10);
  std::vector<ScannedStart> found;
  scan_starts(desk(), settings, {starts, 2}, [&](const auto& one) { found.push_back(one); });
  ASSERT_EQ(found.size(), starts.size());
  Inspector inspector(desk());
  for (const ScannedStart& one : found) {
    Settings window = settings;
    window.start = one.start;
    const auto alone = inspector.inspect(window);
    EXPECT_EQ(one.ok, alone->initialization->ok);
    EXPECT_EQ(one.readiness, alone->initialization->verdict->readiness);
    EXPECT_EQ(one.sigma_deg, alone->initialization->uncertainty->normal_sigma_deg);
    EXPECT_EQ(one.pne_deg, alone->evaluation->pne_deg);
    EXPECT_EQ(one.reason, alone->initialization->verdict->reason);
  }
}

TEST(ScanStarts, ReportWhyAStartFails) {
  std::vector<ScannedStart> found;
  const std::vector<int> starts{3};
  scan_starts(desk(),
              {.frames = 20, .options = {.method = "gpoo"}},
              {.starts = starts},
              [&](const auto& one) { found.push_back(one); });
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].start, 3);
  EXPECT_FALSE(found[0].ok);
  EXPECT_NE(found[0].reason.find("gpoo"), std::string::npos) << found[0].reason;
  const std::string csv = to_csv(found, *desk());
  EXPECT_TRUE(csv.starts_with("start,time_s,status,verdict,sigma_deg,pne_deg,reason\n3,")) << csv;
  EXPECT_EQ(std::ranges::count(csv, ','), 12) << csv;
}

TEST(BestStart, HasTheBestReadinessThenTheLowestUncertainty) {
  const ScannedStart failed{.start = 0, .reason = "no parallax"};
  const ScannedStart certain{
      .start = 1, .ok = true, .readiness = Readiness::weak, .sigma_deg = 0.1};
  const ScannedStart ready{.start = 2, .ok = true, .readiness = Readiness::ready, .sigma_deg = 0.3};
  const ScannedStart best{
      .start = 3, .ok = true, .readiness = Readiness::ready, .sigma_deg = 0.2, .pne_deg = 0.05};
  const ScannedStart unknown{.start = 4, .ok = true, .readiness = Readiness::ready};
  const auto start_of = [](const std::vector<ScannedStart>& starts) {
    const ScannedStart* found = best_start(starts);
    return found == nullptr ? -1 : found->start;
  };
  EXPECT_EQ(start_of({failed, certain, ready, best, unknown}), 3);
  EXPECT_EQ(start_of({failed, unknown, certain}), 4);
  EXPECT_EQ(start_of({failed, certain}), 1);
  EXPECT_EQ(start_of({failed}), -1);
  EXPECT_EQ(start_of({}), -1);
  EXPECT_EQ(to_text(best), "3 (ready, normal +- 0.2 deg, PNE 0.05 deg)");
  EXPECT_EQ(to_text(failed), "0 (failed: no parallax)");
}

}  // namespace
}  // namespace gpo
