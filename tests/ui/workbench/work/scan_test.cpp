// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/scan.h"

#include "tests/engine/desk.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::desk;

void settle(const Scan& scan) {
  while (scan.status().busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(ScanInTheBackground, FindsAllAndKeepsWhatItFound) {
  Scan scan;
  EXPECT_EQ(scan.latest(), nullptr);
  const Settings longer{.start = 7, .frames = desk()->frame_count() - 3};
  const Settings shorter{.frames = desk()->frame_count() - 1};
  scan.want(desk(), longer);
  EXPECT_TRUE(scan.status().busy());
  settle(scan);
  const auto first = scan.latest();
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->starts.size(), 4U);
  EXPECT_TRUE(std::ranges::is_sorted(first->starts, {}, &ScannedStart::start));
  scan.want(desk(), shorter);
  EXPECT_EQ(scan.latest()->of, 2);
  settle(scan);
  scan.want(desk(), Settings{.start = 2, .frames = longer.frames});
  EXPECT_EQ(scan.latest(), first) << "the start of the settings changes nothing";
  EXPECT_FALSE(scan.status().busy());
  scan.want(nullptr, std::nullopt);
  EXPECT_EQ(scan.latest(), nullptr);
}

TEST(ScanInTheBackground, EndsAtOnceWhereNobodyWantsItAnyMore) {
  Scan scan;
  scan.want(desk(), Settings{.frames = 20});
  while (scan.status().done == 0) std::this_thread::yield();
  scan.want(desk(), std::nullopt);
  EXPECT_FALSE(scan.status().busy());
  scan.want(desk(), Settings{.frames = desk()->frame_count() + 1});
  EXPECT_FALSE(scan.status().busy()) << "no window fits";
  EXPECT_EQ(scan.latest()->of, 0);
}

}  // namespace
}  // namespace gpo
