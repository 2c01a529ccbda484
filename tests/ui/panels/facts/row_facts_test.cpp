// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/row_facts.h"

#include "engine/geometry/pose.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"
#include "tests/ui/made_inspection.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {

namespace {

TEST(TrackRows, HaveOneRowPerTrack) {
  const Inspection inspection = made_inspection();
  const auto rows = track_rows(inspection);
  ASSERT_EQ(std::ssize(rows), inspection.tracks->track_count());
  for (const TrackRow& row : rows) {
    const auto column =
        std::ranges::find(inspection.tracks->ids, row.id) - inspection.tracks->ids.begin();
    int seen = 0, inlier = 0;
    for (int i = 0; i < inspection.window->frame_count(); ++i) {
      seen += inspection.tracks->seen(i, static_cast<int>(column)) ? 1 : 0;
      inlier += inspection.window->inlier[i][column] ? 1 : 0;
    }
    EXPECT_EQ(row.seen, seen);
    EXPECT_EQ(row.inlier, inlier);
    EXPECT_EQ(row.rms_px.has_value(), inlier > 0) << row.id;
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
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(order(TrackColumn::seen, false), (Ids{1, 3, 2}));
  EXPECT_EQ(order(TrackColumn::seen, true), (Ids{2, 1, 3}));
  EXPECT_EQ(order(TrackColumn::residual, false), (Ids{3, 2, 1}));
  EXPECT_EQ(order(TrackColumn::residual, true), (Ids{2, 3, 1}));
  EXPECT_EQ(order(TrackColumn::verdict, false), (Ids{2, 1, 3}));
  EXPECT_EQ(order(TrackColumn::track, true), (Ids{3, 2, 1}));
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

TEST(TrackLives, CacheTheLastRequestedOnes) {
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

namespace {

using testing::AllOf;
using testing::HasSubstr;

HomographyCandidate decomposition(double tilt_deg, const std::string& rejected = "") {
  const double tilt = radians(tilt_deg);
  const Eigen::Vector3d normal(0, -std::sin(tilt), -std::cos(tilt));
  return {.frame = 5,
          .motion = {so3_exp({0, 0.1, 0}), {0.3, 0, 0.4}, normal},
          .score = 0.25,
          .rejection = rejected.empty() ? Rejection::none : Rejection::sight,
          .rejected = rejected,
          .behind = 2,
          .of = 80};
}

TEST(CandidateFacts, CountFeasibleDecompositions) {
  const HomographyCandidate first = decomposition(10), second = decomposition(44);
  const HomographyCandidate rejected = decomposition(3, "behind");
  EXPECT_THAT(candidates_sentence(std::vector{first, second, rejected}),
              AllOf(HasSubstr("2 of 3"), HasSubstr("34.0\u00b0")));
  EXPECT_THAT(candidates_sentence(std::vector{rejected, second}),
              AllOf(HasSubstr("1 of 2"), HasSubstr("44.0\u00b0")));
  EXPECT_THAT(candidates_sentence(std::vector{rejected}), HasSubstr("none of 1 decomposition "));
}

TEST(CandidateFacts, FormatNumbers) {
  EXPECT_THAT(
      candidate_cells(decomposition(30)),
      testing::ElementsAre("0.000, -0.500, -0.866", "30.0", "5.73", "0.500", "0.25", "2 of 80"));
}

TEST(CandidateFacts, ExplainMissingDecompositions) {
  NormalStudy study;
  study.candidates = {{}, {decomposition(10)}, {}};
  EXPECT_EQ(why_no_candidates(study, 1), "");
  EXPECT_THAT(why_no_candidates(study, 0), HasSubstr("reference frame"));
  EXPECT_THAT(why_no_candidates(study, 2), HasSubstr("no homography"));
  EXPECT_THAT(why_no_candidates(study, -1), HasSubstr("outside"));
  EXPECT_THAT(why_no_candidates(study, 3), HasSubstr("outside"));
}

TEST(StudyFacts, ExplainAMissingStudy) {
  WorkbenchState state;
  NormalStudy study;
  const auto why = [&] { return why_no_study(state, "computing"); };
  const auto use_study = [&] { state.results.study = std::make_shared<const NormalStudy>(study); };
  EXPECT_EQ(why(), "computing");
  Inspection inspection;
  inspection.window = study.window = std::make_shared<const Window>();
  state.results.inspection = std::make_shared<const Inspection>(inspection);
  EXPECT_EQ(why(), "computing");
  use_study();
  EXPECT_EQ(why(), "");
  study.error = "no memory";
  use_study();
  EXPECT_THAT(why(), HasSubstr("no memory"));
  study.window = std::make_shared<const Window>();
  use_study();
  EXPECT_EQ(why(), "computing") << "the study of another window";
}

}  // namespace

}  // namespace gpo
