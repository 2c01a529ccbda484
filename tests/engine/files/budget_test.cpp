// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/files/budget.h"

#include "tests/engine/test_folder.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::HasSubstr;

double now_s = 0;
double now() { return now_s; }

/// Returns after how many seconds of work `check_stop` throws, at most `most`.
int seconds_allowed(int most) {
  constexpr int kChecks = 64;  // between two looks at the clock
  for (int second = 0; second < most; ++second) {
    for (int i = 0; i < kChecks; ++i) check_stop();
    now_s += 1;
  }
  return most;
}

struct TimeBudget : testing::Test {
  TimeBudget() { now_s = 0; }
  ~TimeBudget() override { set_limits(1); }
  test::TestFolder folder_;
};

TEST_F(TimeBudget, RefusesAnInputThatTakesTooLong) {
  const fs::path file = folder_.write("a.mcap", "small");
  const Budget budget(file, now);
  EXPECT_THAT(test::error_of([] { seconds_allowed(130); }),
              HasSubstr("a.mcap: opening it takes more processor time than is plausible for its "
                        "size; --limits allows more"));
  EXPECT_EQ(now_s, 121);
}

TEST_F(TimeBudget, AllowsMoreForLargerFilesAndRaisedLimits) {
  const fs::path file = folder_.write("a.mcap", std::string(10 << 20, 'x'));
  {
    const Budget budget(file, now);
    EXPECT_EQ(seconds_allowed(130), 130);
  }
  set_limits(4);
  const Budget budget(folder_.path(), now);
  EXPECT_EQ(seconds_allowed(480), 480);
  EXPECT_NE(test::error_of([] { seconds_allowed(2); }), "");
}

TEST_F(TimeBudget, AddsTheFilesOfAFolderAndEndsWithIt) {
  {
    const Budget outer(folder_.path(), now);
    const Budget inner(folder_.write("b.mp4", std::string(5 << 20, 'x')), now);
    EXPECT_EQ(seconds_allowed(125), 125);
  }
  EXPECT_EQ(seconds_allowed(200), 200);
}

TEST_F(TimeBudget, KeepsTheStopOfTheCaller) {
  std::stop_source stop;
  const StopWatch watch{.stop = stop.get_token()};
  const StopScope scope(&watch);
  const Budget budget(folder_.path(), now);
  stop.request_stop();
  EXPECT_THROW(check_stop(), Stopped);
}

TEST_F(TimeBudget, LimitsDecodedPixelsByTheSizeOfTheVideo) {
  const Budget budget(folder_.path(), now);
  spend_pixels("a.mp4", 1000, 20'000'000'000);
  spend_pixels("a.mp4", 1000, 4'000'000);
  EXPECT_THAT(test::error_of([] { spend_pixels("a.mp4", 1000, 1); }),
              HasSubstr("a.mp4: found too many frames to decode for its size"));
}

}  // namespace
}  // namespace gpo
