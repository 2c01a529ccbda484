// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/uncertainty_facts.h"

#include "tests/ui/made_inspection.h"
#include "ui/look/numbers.h"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::HasSubstr;
using testing::Not;

std::map<std::string, ResultRow> uncertainty_rows(const Inspection* inspection) {
  std::map<std::string, ResultRow> rows;
  for (const ResultGroup& group : {verdict_group(*inspection), uncertainty_group(*inspection)}) {
    for (const ResultRow& row : group.rows) rows[row.label] = row;
  }
  return rows;
}

TEST(UncertaintyFacts, UncertaintyIsToldWithUnitsAndModel) {
  const Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  const auto rows = uncertainty_rows(&inspection);
  EXPECT_EQ(rows.at("Rotation alone").value, "8.80 px");
  EXPECT_EQ(rows.at("Rotation alone").note, "noise 0.40 px");
  EXPECT_EQ(rows.at("Moved").value, "0.450 d");
  EXPECT_EQ(rows.at("Normal").value, "\u00b10.310\u00b0");
  EXPECT_EQ(rows.at("Normal").note, "gyro bias unknown");
  EXPECT_EQ(rows.at("Distance ratio").value, "0.9978 \u00b10.0013");
  EXPECT_EQ(rows.at("Bias x").value, "0.01230 \u00b10.00050 rad/s");
  EXPECT_EQ(rows.at("Bound, known rotations").value, "0.186\u00b0");
  EXPECT_EQ(rows.at("Bound, unknown bias").value, "0.279\u00b0");
  for (const char* label : {"Bound, known rotations", "Bound, unknown bias"}) {
    EXPECT_THAT(rows.at(label).tooltip, HasSubstr("degrees"));
  }
}

TEST(UncertaintyFacts, WithoutUncertaintyAreDashesThatSayWhy) {
  const Inspection inspection = made_inspection({.images = false});
  const auto rows = uncertainty_rows(&inspection);
  for (const char* label : {"Rotation alone", "Moved", "Normal", "Distance ratio"}) {
    EXPECT_EQ(rows.at(label).value, "\u2013");
    EXPECT_THAT(rows.at(label).tooltip, HasSubstr("Not known"));
  }
  EXPECT_EQ(rows.count("Bias x"), 0U);
}

TEST(TimeLine, BarTellsTheVerdictOfTheWindowThatEndsThere) {
  const Inspection inspection = made_inspection({.images = false, .normal_sigma_deg = 0.31});
  EXPECT_EQ(bar_text(inspection, 4), "frame 4");
  EXPECT_THAT(bar_text(inspection, 5), HasSubstr("inliers. The window starts here"));
  EXPECT_THAT(bar_text(inspection, 5), Not(HasSubstr("ready")));
  EXPECT_THAT(bar_text(inspection, 6), HasSubstr("window of 2 frames, 5 to 6: degenerate, normal"));
  EXPECT_THAT(bar_text(inspection, 14), HasSubstr("window of 10 frames, 5 to 14: weak, normal"));
  EXPECT_THAT(bar_text(inspection, 34), HasSubstr("window of 30 frames, 5 to 34: ready, normal"));
  EXPECT_THAT(bar_text(inspection, 34),
              HasSubstr("normal \u00b1" +
                        angle_text(*inspection.initialization->verdict->normal_sigma_deg)))
      << "the whole window's number is the result's";
  EXPECT_THAT(bar_text(inspection, 34), Not(HasSubstr("rotations as given")));
  EXPECT_EQ(bar_text(inspection, 35), "frame 35");
}

}  // namespace
}  // namespace gpo
