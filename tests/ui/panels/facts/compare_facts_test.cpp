// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/compare_facts.h"

#include "tests/ui/made_inspection.h"
#include "ui/look/numbers.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

Compared made(double pne_deg, double rms_px, const MadeOptions& options = {}) {
  auto inspection = std::make_shared<Inspection>(made_inspection(options));
  if (inspection->evaluation) inspection->evaluation->pne_deg = pne_deg;
  auto result = std::make_shared<Initialization>(*inspection->initialization);
  result->rms_px = rms_px;
  inspection->initialization = result;
  inspection->timing.initialize = 2;
  return {configuration_of(inspection->settings), inspection->settings, inspection, ""};
}

const ComparedNumber& number(const ComparedRow& row, const std::string& title) {
  const auto columns = compared_columns();
  const auto found = std::ranges::find(columns, title, &ComparedColumn::title);
  return row.numbers.at(found - columns.begin());
}

TEST(CompareFacts, DifferFromTheFirstRowAbsolutelyAndRelatively) {
  const auto rows = compared_rows({made(0.2, 0.5), made(0.3, 0.25), made(0.2, 0.5)}, true);
  EXPECT_EQ(number(rows[0], "PNE").difference, "");
  EXPECT_EQ(number(rows[1], "PNE").text, "0.300\u00b0");
  EXPECT_EQ(number(rows[1], "PNE").difference, "+0.100\u00b0 +50 %");
  EXPECT_EQ(number(rows[1], "RMS").difference, "\u22120.250 px \u221250 %");
  EXPECT_EQ(number(rows[2], "PNE").difference, "\u00b10");
}

TEST(CompareFacts, LimitWorseToOneOctave) {
  const auto rows = compared_rows({made(0.2, 0.5), made(0.3, 0.25), made(2, 0.49)}, true);
  EXPECT_NEAR(number(rows[1], "PNE").worse, std::log2(1.5), 1e-9);
  EXPECT_DOUBLE_EQ(number(rows[1], "RMS").worse, -1);
  EXPECT_DOUBLE_EQ(number(rows[2], "PNE").worse, 1);
  EXPECT_DOUBLE_EQ(number(rows[0], "PNE").worse, 0);
  EXPECT_DOUBLE_EQ(number(rows[1], "Inliers").worse, 0) << "neither is better";
}

TEST(CompareFacts, ShowLargeRatiosAsFactors) {
  const auto rows = compared_rows({made(0.01, 0.5), made(0.5, 0.5)}, true);
  EXPECT_THAT(number(rows[1], "PNE").difference, HasSubstr("\u00d750"));
}

TEST(CompareFacts, ExplainUnknownValues) {
  const auto blind = compared_rows({made(0, 0.5, {.truth = false})}, false);
  EXPECT_EQ(number(blind[0], "PNE").text, "\u2013");
  EXPECT_THAT(number(blind[0], "PNE").why_not, HasSubstr("no ground truth"));
  EXPECT_EQ(number(blind[0], "Initialize").text, "\u2013");
  EXPECT_THAT(number(blind[0], "Initialize").why_not, HasSubstr("no times"));
  EXPECT_EQ(number(compared_rows({made(0, 0.5)}, true)[0], "Initialize").text, "2.0 ms");
}

TEST(CompareFacts, NameFailedAndUnfinishedResults) {
  Compared failed = made(0, 0, {.ok = false}), missing = made(0, 0), refused = made(0, 0);
  missing.inspection.reset();
  refused.inspection.reset();
  refused.error = "no gyroscope";
  const auto rows = compared_rows({made(0.2, 0.5), failed, missing, refused}, true);
  EXPECT_EQ(rows[1].status, "failed");
  EXPECT_EQ(rows[1].reason, failed.inspection->initialization->reason);
  EXPECT_EQ(number(rows[1], "RMS").difference, "");
  EXPECT_EQ(rows[2].status, "computing");
  EXPECT_THAT(rows[2].numbers, IsEmpty());
  EXPECT_EQ(rows[3].status, "not computed");
  EXPECT_EQ(rows[3].reason, "no gyroscope");
}

TEST(CompareFacts, FormatDifferencesWithSignAndUnit) {
  EXPECT_EQ(difference_text(0.5, 0.2, angle_text), "+0.300\u00b0");
  EXPECT_EQ(difference_text(0.001, 0.0023, length_text), "\u22121.30 mm");
  EXPECT_EQ(difference_text(0.5, 0.5, angle_text), "\u00b10");
}

TEST(CompareFacts, SortByAColumnWithUnknownValuesLast) {
  const auto rows =
      compared_rows({made(0.2, 0.5), made(0, 0, {.ok = false}), made(0.1, 0.3)}, true);
  const auto columns = compared_columns();
  const auto rms = static_cast<int>(
      std::ranges::find(columns, std::string("RMS"), &ComparedColumn::title) - columns.begin());
  EXPECT_THAT(in_order(rows, {}), testing::ElementsAre(0, 1, 2));
  EXPECT_THAT(in_order(rows, {rms, false}), testing::ElementsAre(2, 0, 1));
  EXPECT_THAT(in_order(rows, {rms, true}), testing::ElementsAre(0, 2, 1));
}

TEST(CompareFacts, WriteCsvWithUnitsAndFullPrecision) {
  const auto rows = compared_rows({made(0.25, 0.5), made(0, 0, {.ok = false})}, false);
  const std::string csv = to_csv(rows);
  EXPECT_THAT(csv,
              testing::StartsWith("method,status,Inliers,RMS [px],Iterations,Initialize [ms],PNE "
                                  "[deg],PNE aligned [deg],PDE [m],ATE [m],"));
  EXPECT_THAT(csv, HasSubstr(",ok,"));
  EXPECT_THAT(csv, HasSubstr(",0.5,"));
  EXPECT_THAT(csv, HasSubstr(",0.25,"));
  EXPECT_THAT(csv, HasSubstr(",failed,,,,"));
}

}  // namespace
}  // namespace gpo
