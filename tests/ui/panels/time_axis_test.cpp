// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/time_axis.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(TimeAxis, FrameUnderItsOwnMiddleIsItself) {
  for (const int frames : {1, 2, 60, 5000}) {
    const TimeAxis axis{100, 1100, frames};
    for (int i = 0; i < frames; ++i) ASSERT_EQ(frame_at(axis, slot_middle(axis, i)), i);
  }
}

TEST(TimeAxis, BeyondItsEndsAreTheFirstAndLastFrame) {
  const TimeAxis axis{100, 1100, 60};
  EXPECT_EQ(frame_at(axis, -50), 0);
  EXPECT_EQ(frame_at(axis, 100), 0);
  EXPECT_EQ(frame_at(axis, 1100), 59);
  EXPECT_EQ(frame_at(axis, 5000), 59);
}

TEST(TimeAxis, SlotsFillTheBar) {
  const TimeAxis axis{100, 1100, 60};
  EXPECT_FLOAT_EQ(slot_begin(axis, 0), 100);
  EXPECT_FLOAT_EQ(slot_begin(axis, 60), 1100);
}

}  // namespace
}  // namespace gpo
