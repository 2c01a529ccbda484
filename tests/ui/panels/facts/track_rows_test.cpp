// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/panels/panels.h"

#include <cmath>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::ElementsAre;

TEST(TrackRows, HaveOneRowPerTrack) {
  const Inspection inspection = made_inspection();
  const auto rows = track_rows(inspection);
  ASSERT_EQ(std::ssize(rows), inspection.tracks->track_count());
  for (const TrackRow& row : rows) {
    const int column = *column_of(*inspection.tracks, row.id);
    const bool at_first = inspection.window->inlier[0][column];
    int seen = 0, inlier = 0;  // the reference frame measures nothing
    for (int i = 1; i < inspection.window->frame_count(); ++i) {
      seen += inspection.tracks->seen(i, column);
      inlier += inspection.window->inlier[i][column];
    }
    EXPECT_EQ(row.seen, seen);
    EXPECT_EQ(row.inlier, inlier);
    EXPECT_EQ(row.rms_px.has_value(), at_first || inlier > 0) << row.id;
  }
}

TEST(TrackRows, SortByAnyColumnWithUnknownValuesLast) {
  std::vector<TrackRow> rows = {{.id = 1, .seen = 5, .verdict = "b"},
                                {.id = 2, .seen = 9, .rms_px = 0.5, .verdict = "a"},
                                {.id = 3, .seen = 5, .rms_px = 0.2, .verdict = "c"}};
  const auto order = [&](TrackColumn by, bool descending) {
    sort_tracks(rows, by, descending);
    return std::vector{rows[0].id, rows[1].id, rows[2].id};
  };
  EXPECT_THAT(order(TrackColumn::seen, false), ElementsAre(1, 3, 2));
  EXPECT_THAT(order(TrackColumn::seen, true), ElementsAre(2, 1, 3));
  EXPECT_THAT(order(TrackColumn::residual, false), ElementsAre(3, 2, 1));
  EXPECT_THAT(order(TrackColumn::residual, true), ElementsAre(2, 3, 1));
  EXPECT_THAT(order(TrackColumn::verdict, false), ElementsAre(2, 1, 3));
  EXPECT_THAT(order(TrackColumn::track, true), ElementsAre(3, 2, 1));
}

TEST(TrackRows, AreCopiedAsCsvWithUnits) {
  const TrackRow row{
      .id = 7, .seen = 3, .inlier = 2, .plane = 2, .rms_px = 0.25, .verdict = "a, b"};
  EXPECT_EQ(to_csv({&row, 1}),
            "track,frames seen,frames inlier,plane,residual [px],depth [d],verdict\n"
            "7,3,2,2,0.25,,a; b\n");
}

TEST(TrackLives, AreComputedOncePerTrackAndResult) {
  const Inspection inspection = made_inspection();
  TrackLives lives;
  EXPECT_EQ(lives.of(inspection, 3).id, inspection.tracks->ids[3]);
  EXPECT_EQ(lives.of(inspection, 4).column, 4);
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(lives.of(inspection, 3).verdict, track_life(inspection, 3).verdict);
  EXPECT_EQ(lives.computed(), 2U);
  const Inspection copy = inspection;
  lives.of(copy, 3);
  EXPECT_EQ(lives.computed(), 2U) << "only the cube could differ";
  Inspection other = inspection;
  other.initialization = std::make_shared<const Initialization>(*inspection.initialization);
  lives.of(other, 3);
  EXPECT_EQ(lives.computed(), 3U);
  lives.of(inspection, 3);
  EXPECT_EQ(lives.computed(), 3U) << "both are cached";
}

}  // namespace
}  // namespace gpo
