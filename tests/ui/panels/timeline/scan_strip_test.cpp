// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/timeline/scan_strip.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

StartScan three() {
  StartScan scan{.settings = {}, .step = 10, .of = 4, .starts = {}};
  scan.starts = {
      {.start = 0, .ok = true, .readiness = Readiness::ready, .sigma_deg = 0.1, .reason = "fine"},
      {.start = 10, .ok = false, .reason = "too few tracks"},
      {.start = 30, .ok = true, .readiness = Readiness::weak, .sigma_deg = 10}};
  return scan;
}

TEST(ScanStrip, FindsTheStartOfAColumn) {
  const StartScan scan = three();
  EXPECT_EQ(start_at(scan, 0)->start, 0);
  EXPECT_EQ(start_at(scan, 9)->start, 0);
  EXPECT_EQ(start_at(scan, 10)->start, 10);
  EXPECT_EQ(start_at(scan, 25), nullptr) << "not scanned yet";
  EXPECT_EQ(start_at(scan, 31)->start, 30);
  EXPECT_EQ(start_at(scan, 90), nullptr);
}

TEST(ScanStrip, ColumnsAreAsHighAsTheLogarithmOfWhatIsKnownOfTheNormal) {
  StartScan scan = three();
  const auto sigma = shown_error(scan);
  EXPECT_TRUE(sigma == &ScannedStart::sigma_deg);
  EXPECT_NEAR(column_height(scan.starts[0], sigma), 1 / 3.0, 1e-6);
  EXPECT_EQ(column_height(scan.starts[1], sigma), 1);
  EXPECT_NEAR(column_height(scan.starts[2], sigma), 1, 1e-6);
  scan.starts[0].pne_deg = 0.001;
  EXPECT_TRUE(shown_error(scan) == &ScannedStart::pne_deg);
  EXPECT_EQ(column_height(scan.starts[0], shown_error(scan)), 0);
}

TEST(ScanStrip, SaysWhatCameOfAStart) {
  StartScan scan = three();
  scan.starts[0].pne_deg = 0.25;
  EXPECT_EQ(scan_text(scan.starts[0]),
            "start 0: ready, normal \u00b10.100\u00b0, PNE 0.250\u00b0\nfine");
  EXPECT_EQ(scan_text(scan.starts[1]), "start 10: not initialized\ntoo few tracks");
}

}  // namespace
}  // namespace gpo
