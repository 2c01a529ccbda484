// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/panels/facts/track_rows.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(TrackLives, AreComputedOnceATrackAndAgainForAnotherResult) {
  const Inspection inspection = made_inspection();
  TrackLives lives;
  EXPECT_EQ(lives.of(inspection, 3).id, inspection.tracks->ids[3]);
  EXPECT_EQ(lives.of(inspection, 4).column, 4);
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(lives.of(inspection, 3).verdict, track_life(inspection, 3).verdict);
  EXPECT_EQ(lives.computed(), 2U);
  Inspection moved = inspection;  // as when its cube is moved
  lives.of(moved, 3);
  EXPECT_EQ(lives.computed(), 2U);
  Inspection other = inspection;
  other.initialization = std::make_shared<const Initialization>(*inspection.initialization);
  lives.of(other, 3);
  EXPECT_EQ(lives.computed(), 3U);
  lives.of(inspection, 3);
  EXPECT_EQ(lives.computed(), 3U) << "both are kept";
}

TEST(TrackLives, ThoseAskedForLastAreKept) {
  const Inspection inspection = made_inspection();
  TrackLives lives;
  for (int column = 0; column < 100; ++column) {
    lives.of(inspection, column);
    lives.of(inspection, 0);
  }
  EXPECT_EQ(lives.computed(), 100U);
  lives.of(inspection, 1);
  EXPECT_EQ(lives.computed(), 101U);
}

}  // namespace
}  // namespace gpo
