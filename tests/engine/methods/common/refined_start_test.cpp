// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/common/window_checks.h"
#include "engine/methods/initializers.h"
#include "engine/window/window.h"
#include "tests/engine/simulated_window.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::Motion;
using test::simulate;

Initialization no_start(const Window& /*unused*/, const Watch& /*unused*/) {
  Initialization result = failed("the moon is full");
  result.candidates.resize(3);
  return result;
}

Initialization some_start(const Window& /*unused*/, const Watch& /*unused*/) {
  Initialization result;
  result.ok = true;
  result.candidates.resize(2);
  return result;
}

Initialization refine(const Window& /*unused*/,
                      const Initialization& start,
                      const Watch& /*unused*/) {
  Initialization result;
  result.ok = start.ok;
  result.rms_px = 0.5;
  return result;
}

TEST(RefinedStart, ReturnsRefinementWithCandidatesOfStart) {
  const Initialization result =
      refined_start(simulate({}).window, {"Some", some_start}, refine, {});
  EXPECT_TRUE(result.ok);
  EXPECT_EQ(result.rms_px, 0.5);
  EXPECT_EQ(result.candidates.size(), 2U);
}

TEST(RefinedStart, ReportsFailedStartAndKeepsItsCandidates) {
  const Initialization result = refined_start(simulate({}).window, {"None", no_start}, refine, {});
  EXPECT_FALSE(result.ok);
  EXPECT_EQ(result.reason, "start by None: the moon is full");
  EXPECT_EQ(result.candidates.size(), 3U);
}

TEST(RefinedStart, ReportsStoppedStartAsStopped) {
  const Window window = simulate({}).window;
  std::stop_source source;
  source.request_stop();
  const Initialization result =
      refined_start(window, {"DBSCAN", initialize_dbscan}, refine, source.get_token());
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(result.reason, "stopped");
  EXPECT_TRUE(initialize_pnp(window, source.get_token()).stopped);
  EXPECT_FALSE(refined_start(window, {"None", no_start}, refine, {}).stopped);
}

TEST(RefinedStart, ReportsMissingParallaxItself) {
  const Window window = simulate({.motion = Motion::rotation_only}).window;
  const Initialization result = refined_start(window, {"None", no_start}, refine, {});
  EXPECT_FALSE(result.ok);
  EXPECT_THAT(result.reason, ::testing::StartsWith("no parallax"));
}

}  // namespace
}  // namespace gpo
