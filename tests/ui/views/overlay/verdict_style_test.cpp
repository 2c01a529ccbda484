// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/views/overlay/plane_style.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

using enum Readiness;

TEST(VerdictStyle, ShapesAndColorsDiffer) {
  const ReadinessStyle a = style_of(ready), b = style_of(weak), c = style_of(degenerate);
  EXPECT_TRUE(a.sign != b.sign && b.sign != c.sign && a.sign != c.sign);
  EXPECT_TRUE(a.rgb != b.rgb && b.rgb != c.rgb && a.rgb != c.rgb);
}

TEST(VerdictStyle, TextSaysWhatIsKnownAndNoMore) {
  EXPECT_EQ(verdict_text({weak, "", 0.31, 1.2, 0.4, 0.1}),
            "weak, normal \u00b10.310\u00b0, rotation alone leaves 1.20 px where noise is 0.40 px, "
            "moved 0.100 d");
  EXPECT_EQ(verdict_text(Verdict()), "degenerate");
}

TEST(VerdictStyle, RunsCountFramesOfTheWindow) {
  std::vector<Verdict> growth(5);
  growth[2].readiness = weak;
  growth[3].readiness = growth[4].readiness = ready;
  EXPECT_THAT(verdict_runs(growth),
              testing::ElementsAre(
                  VerdictRun{1, 2, degenerate}, VerdictRun{3, 3, weak}, VerdictRun{4, 5, ready}));
  EXPECT_TRUE(verdict_runs({}).empty());
}

TEST(VerdictStyle, OfTheWholeWindowIsItsResults) {
  Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  auto result = std::make_shared<Initialization>(*inspection.initialization);
  result->verdict->readiness = weak;
  inspection.initialization = result;
  const std::vector<Verdict> shown = shown_growth(inspection);
  ASSERT_EQ(shown.size(), inspection.growth.size());
  EXPECT_EQ(inspection.growth.back().readiness, ready);
  EXPECT_EQ(shown.back().readiness, weak);
  EXPECT_EQ(shown[shown.size() - 2].readiness, ready);
  result->verdict.reset();
  EXPECT_EQ(shown_growth(inspection).back().readiness, ready) << "there is no other";
}

}  // namespace
}  // namespace gpo
