// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/timeline_bars.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(TimeAxis, FindsTheFrameInTheMiddleOfItsSlot) {
  for (const int frames : {1, 2, 60, 5000}) {
    const TimeAxis axis{100, 1100, frames};
    for (int i = 0; i < frames; ++i) ASSERT_EQ(axis.frame_at(axis.slot_middle(i)), i);
    EXPECT_FLOAT_EQ(axis.slot_begin(0), 100);
    EXPECT_FLOAT_EQ(axis.slot_begin(frames), 1100);
  }
}

TEST(TimeAxis, ClampsToTheRecording) {
  const TimeAxis axis{100, 1100, 60};
  // Dear ImGui's position of no pointer is the lowest number.
  using Limits = std::numeric_limits<float>;
  for (const float x : {-50.0F, 100.0F, Limits::lowest()}) EXPECT_EQ(axis.frame_at(x), 0);
  for (const float x : {1100.0F, 5000.0F, Limits::max()}) EXPECT_EQ(axis.frame_at(x), 59);
}

TEST(TimeAxis, ShowsASpan) {
  const TimeAxis axis{100, 1100, 20000, {500, 100}};
  EXPECT_FLOAT_EQ(axis.slot_begin(500), 100);
  EXPECT_FLOAT_EQ(axis.slot_begin(600), 1100);
  EXPECT_EQ(axis.frame_at(605), 550);
  EXPECT_EQ(axis.frame_at(90), 499) << "a drag continues outside of the span";
  EXPECT_EQ(axis.frame_at(-1e6), 0);
}

TEST(Ruler, HasRoundTimesWithTheirFrames) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 60; ++i) times.push_back(7'000'000'000 + i * 33'333'333LL);
  const TimeAxis axis{100, 1100, 60};
  const std::vector<RulerTick> ticks = ruler_ticks(axis, times, 110);
  ASSERT_EQ(ticks.size(), 4U);
  EXPECT_EQ(ticks[0].text, "0.0 s \u00b7 0");
  EXPECT_EQ(ticks[1].text, "0.5 s \u00b7 15");
  EXPECT_EQ(ticks[3].frame, 45);
  for (std::size_t i = 1; i < ticks.size(); ++i)
    EXPECT_GT(axis.slot_middle(ticks[i].frame) - axis.slot_middle(ticks[i - 1].frame), 110);
  const TimeAxis zoomed{100, 1100, 60, {30, 10}};
  for (const RulerTick& tick : ruler_ticks(zoomed, times, 110)) {
    EXPECT_GE(tick.frame, 30);
    EXPECT_LE(tick.frame, 39);
  }
  EXPECT_GE(ruler_ticks(zoomed, times, 110).size(), 3U);
  EXPECT_TRUE(ruler_ticks({100, 1100, 1}, std::vector<std::int64_t>{5}, 110).empty());
}

TEST(Ruler, LabelsTheFrameAfterAGapOnce) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 60; ++i) times.push_back((i < 3 ? 0 : 2'900'000'010) + i * 33'333'333LL);
  std::vector<std::string> texts;
  for (const RulerTick& tick : ruler_ticks({100, 1100, 60}, times, 110)) texts.push_back(tick.text);
  EXPECT_EQ(texts, (std::vector<std::string>{"0 s \u00b7 0", "3 s \u00b7 3", "4 s \u00b7 33"}));
}

TEST(Ruler, TellsTheTimeOfTheFrame) {
  std::vector<std::int64_t> times;
  for (int i = 0; i < 10; ++i) times.push_back(i * 360'000'000LL);
  std::vector<std::string> texts;
  for (const RulerTick& tick : ruler_ticks({100, 1100, 10}, times, 250)) texts.push_back(tick.text);
  EXPECT_EQ(texts,
            (std::vector<std::string>{
                "0 s \u00b7 0", "1.1 s \u00b7 3", "2.2 s \u00b7 6", "3.2 s \u00b7 9"}));
}

TEST(TimeSpan, ZoomsAroundTheMouse) {
  TimeSpan span;
  for (int i = 0; i < 20; ++i) span = zoomed(span, 20000, 0.25, 0.8);
  EXPECT_NEAR(span.first + 0.25 * span.count, 5000, 5);
  EXPECT_NEAR(span.count, 20000 * std::pow(0.8, 20), 20);
  for (int i = 0; i < 100; ++i) span = zoomed(span, 20000, 0.25, 0.8);
  EXPECT_EQ(span.count, 10);
  for (int i = 0; i < 100; ++i) span = zoomed(span, 20000, 0.9, 1.25);
  EXPECT_EQ(span, TimeSpan{});
  EXPECT_EQ(zoomed({}, 5, 0.5, 0.1), TimeSpan{}) << "too short to zoom";
}

TEST(TimeSpan, FollowsTheCurrentFrame) {
  for (const auto& [frame, first] : {std::pair{120, 100}, {150, 101}, {20, 20}})
    EXPECT_EQ(holding({100, 50}, frame), (TimeSpan{first, 50}));
  EXPECT_EQ(holding({}, 20), TimeSpan{});
}

TEST(TimeSpan, StartsAroundTheWindowInALongRecording) {
  Settings settings;
  settings.start = 1000;
  EXPECT_EQ(first_time_span(settings, 1400), TimeSpan{});
  const TimeSpan span = first_time_span(settings, 20000);
  EXPECT_LT(span.count, 20 * settings.frames);
  EXPECT_LE(span.first, settings.start);
  EXPECT_GE(span.first + span.count, settings.start + settings.frames);
  EXPECT_EQ(around_window(settings, 60), TimeSpan{});
}

StartScan three_starts() {
  StartScan scan{.settings = {}, .step = 10, .of = 4, .starts = {}};
  scan.starts = {
      {.start = 0, .ok = true, .readiness = Readiness::ready, .sigma_deg = 0.1, .reason = "fine"},
      {.start = 10, .ok = false, .reason = "too few tracks"},
      {.start = 30, .ok = true, .readiness = Readiness::weak, .sigma_deg = 10}};
  return scan;
}

TEST(ScanStrip, FindsTheStartOfAColumn) {
  const StartScan scan = three_starts();
  for (const auto& [frame, start] : {std::pair{0, 0}, {9, 0}, {10, 10}, {31, 30}})
    EXPECT_EQ(start_at(scan, frame)->start, start);
  EXPECT_EQ(start_at(scan, 25), nullptr) << "not scanned yet";
  EXPECT_EQ(start_at(scan, 90), nullptr);
}

TEST(ScanStrip, ScalesColumnsLogarithmically) {
  StartScan scan = three_starts();
  const auto sigma = shown_error(scan);
  EXPECT_TRUE(sigma == &ScannedStart::sigma_deg);
  EXPECT_NEAR(column_height(scan.starts[0], sigma), 1 / 3.0, 1e-6);
  EXPECT_EQ(column_height(scan.starts[1], sigma), 1);
  EXPECT_NEAR(column_height(scan.starts[2], sigma), 1, 1e-6);
  scan.starts[0].pne_deg = 0.001;
  EXPECT_TRUE(shown_error(scan) == &ScannedStart::pne_deg);
  EXPECT_EQ(column_height(scan.starts[0], shown_error(scan)), 0);
}

TEST(ScanStrip, DescribesAStart) {
  StartScan scan = three_starts();
  scan.starts[0].pne_deg = 0.25;
  EXPECT_EQ(scan_text(scan.starts[0]),
            "start 0: ready, normal \u00b10.100\u00b0, PNE 0.250\u00b0\nfine");
  EXPECT_EQ(scan_text(scan.starts[1]), "start 10: not initialized\ntoo few tracks");
}

}  // namespace
}  // namespace gpo
