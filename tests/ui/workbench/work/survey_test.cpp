// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/work/survey.h"

#include "engine/base/error.h"
#include "engine/window/window.h"
#include "tests/engine/desk.h"
#include "tests/engine/simulated_window.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace gpo {
namespace {

using test::desk;

std::shared_ptr<const Inspection> inspection_of(const std::shared_ptr<const Recording>& recording,
                                                int frames) {
  Inspection inspection;
  inspection.recording = recording;
  inspection.window = std::make_shared<const Window>(test::simulate({.frames = frames}).window);
  return std::make_shared<const Inspection>(inspection);
}

void settle(const auto& job) {
  while (job.status().busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(SurveyStudy, BelongsToTheLastRequestedWindow) {
  const auto recording = std::make_shared<const Recording>();
  const auto first = inspection_of(recording, 20), second = inspection_of(recording, 8);
  Survey survey;
  survey.open(recording);
  EXPECT_EQ(survey.latest_study(), nullptr);
  survey.study(first);
  EXPECT_TRUE(survey.status().busy());
  EXPECT_FALSE(survey.status().stage.empty());
  survey.study(second);
  settle(survey);
  ASSERT_NE(survey.latest_study(), nullptr);
  EXPECT_EQ(survey.latest_study()->window, second->window);
  const auto study = survey.latest_study();
  survey.study(second);
  EXPECT_FALSE(survey.status().busy()) << "already studied";
  EXPECT_EQ(survey.latest_study(), study);
}

TEST(SurveyStudy, StopsOnRequestAndIsDiscardedWithItsRecording) {
  const auto recording = std::make_shared<const Recording>();
  const auto inspection = inspection_of(recording, 8);
  Survey survey;
  survey.open(recording);
  survey.study(inspection_of(recording, 60));
  survey.study(nullptr);
  EXPECT_FALSE(survey.status().busy());
  survey.study(inspection);
  settle(survey);
  ASSERT_NE(survey.latest_study(), nullptr);
  survey.open(std::make_shared<const Recording>());
  EXPECT_EQ(survey.latest_study(), nullptr);
  survey.study(inspection);
  EXPECT_FALSE(survey.status().busy()) << "of another recording";
}

TEST(SurveyStudy, FailureIsKeptWithItsReasonAndNotRetried) {
  const auto recording = std::make_shared<const Recording>();
  const auto first = inspection_of(recording, 8), second = inspection_of(recording, 6);
  std::atomic<int> tried = 0;
  Survey survey({}, [&](const Inspection&, const std::stop_token&) {
    ++tried;
    throw InputError("no frame has enough tracks");
    return std::shared_ptr<const NormalStudy>();
  });
  survey.open(recording);
  survey.study(first);
  settle(survey);
  ASSERT_NE(survey.latest_study(), nullptr);
  EXPECT_EQ(survey.latest_study()->window, first->window);
  EXPECT_EQ(survey.latest_study()->error, "no frame has enough tracks");
  survey.study(first);
  EXPECT_FALSE(survey.status().busy()) << "it would fail again";
  EXPECT_EQ(tried, 1);
  survey.study(second);
  settle(survey);
  EXPECT_EQ(survey.latest_study()->window, second->window);
  EXPECT_EQ(tried, 2);
}

TEST(ScanInTheBackground, FindsAllStartsAndCachesThem) {
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
  EXPECT_EQ(scan.latest(), first) << "the start of the settings is ignored";
  EXPECT_FALSE(scan.status().busy());
  scan.want(nullptr, std::nullopt);
  EXPECT_EQ(scan.latest(), nullptr);
}

TEST(ScanInTheBackground, StopsAtOnceOnRequest) {
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
