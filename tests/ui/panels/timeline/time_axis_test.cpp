// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/time_axis.h"

#include <cmath>
#include <limits>

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
  // A pointer that is nowhere, as Dear ImGui says it.
  EXPECT_EQ(frame_at(axis, std::numeric_limits<float>::lowest()), 0);
  EXPECT_EQ(frame_at(axis, std::numeric_limits<float>::max()), 59);
}

TEST(TimeAxis, ShowsASpan) {
  const TimeAxis axis{100, 1100, 20000, {500, 100}};
  EXPECT_FLOAT_EQ(slot_begin(axis, 500), 100);
  EXPECT_FLOAT_EQ(slot_begin(axis, 600), 1100);
  EXPECT_EQ(frame_at(axis, 605), 550);
  EXPECT_EQ(frame_at(axis, 90), 499);  // dragging beyond it goes on
  EXPECT_EQ(frame_at(axis, -1e6), 0);
}

TEST(TimeSpan, ZoomsAboutWhatIsUnderTheMouse) {
  TimeSpan span;
  for (int i = 0; i < 20; ++i) span = zoomed(span, 20000, 0.25, 0.8);
  EXPECT_NEAR(span.first + 0.25 * span.count, 5000, 5);
  EXPECT_NEAR(span.count, 20000 * std::pow(0.8, 20), 20);
  for (int i = 0; i < 100; ++i) span = zoomed(span, 20000, 0.25, 0.8);
  EXPECT_EQ(span.count, 10);
  for (int i = 0; i < 100; ++i) span = zoomed(span, 20000, 0.9, 1.25);
  EXPECT_EQ(span, TimeSpan{});
  EXPECT_EQ(zoomed({}, 5, 0.5, 0.1), TimeSpan{});  // too short to zoom
}

TEST(TimeSpan, HoldsTheFrameThatIsShown) {
  EXPECT_EQ(holding({100, 50}, 120), (TimeSpan{100, 50}));
  EXPECT_EQ(holding({100, 50}, 150), (TimeSpan{101, 50}));
  EXPECT_EQ(holding({100, 50}, 20), (TimeSpan{20, 50}));
  EXPECT_EQ(holding({}, 20), TimeSpan{});
}

TEST(TimeSpan, OfALongRecordingBeginsAroundTheWindow) {
  Settings settings;
  settings.start = 1000;
  EXPECT_EQ(first_time_span(settings, 1400), TimeSpan{});
  const TimeSpan span = first_time_span(settings, 20000);
  EXPECT_LT(span.count, 20 * settings.frames);
  EXPECT_LE(span.first, settings.start);
  EXPECT_GE(span.first + span.count, settings.start + settings.frames);
  EXPECT_EQ(around_window(settings, 60), TimeSpan{});
}

TEST(TimeAxis, SlotsFillTheBar) {
  const TimeAxis axis{100, 1100, 60};
  EXPECT_FLOAT_EQ(slot_begin(axis, 0), 100);
  EXPECT_FLOAT_EQ(slot_begin(axis, 60), 1100);
}

}  // namespace
}  // namespace gpo
