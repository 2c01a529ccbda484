// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/report_timer.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

using std::chrono::seconds;

TEST(ReportTimer, IsDueEveryTenSeconds) {
  const ReportTimer::Clock::time_point begin{};
  ReportTimer pace(begin);
  EXPECT_FALSE(pace.due(begin));
  EXPECT_FALSE(pace.due(begin + seconds(9)));
  EXPECT_TRUE(pace.due(begin + seconds(10)));
  EXPECT_FALSE(pace.due(begin + seconds(19)));
  EXPECT_TRUE(pace.due(begin + seconds(45)));
  EXPECT_FALSE(pace.due(begin + seconds(54)));
}

}  // namespace
}  // namespace gpo
