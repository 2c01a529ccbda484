// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/candidate_facts.h"

#include "engine/geometry/pose.h"

#include <cmath>

#include <gmock/gmock.h>

namespace gpo {
namespace {

using testing::HasSubstr;

HomographyCandidate reading(double tilt_deg, const std::string& rejected = "") {
  const double tilt = radians(tilt_deg);
  const Eigen::Vector3d normal(0, -std::sin(tilt), -std::cos(tilt));
  return {5,
          {so3_exp({0, 0.1, 0}), {0.3, 0, 0.4}, normal},
          0.25,
          rejected.empty() ? Rejection::none : Rejection::sight,
          rejected,
          2,
          80};
}

TEST(CandidateFacts, SayHowManyReadingsArePossibleAndWhatPartsThem) {
  EXPECT_THAT(candidates_sentence(std::vector{reading(10), reading(44), reading(3, "behind")}),
              testing::AllOf(HasSubstr("2 of 3"), HasSubstr("34.0\u00b0")));
  EXPECT_THAT(candidates_sentence(std::vector{reading(10, "a"), reading(44)}),
              testing::AllOf(HasSubstr("1 of 2"), HasSubstr("44.0\u00b0")));
  EXPECT_THAT(candidates_sentence(std::vector{reading(10, "a")}), HasSubstr("none of 1"));
}

TEST(CandidateFacts, CellsAreTheNumbersOfTheReading) {
  EXPECT_THAT(
      candidate_cells(reading(30)),
      testing::ElementsAre("0.000, -0.500, -0.866", "30.0", "5.73", "0.500", "0.25", "2 of 80"));
}

TEST(CandidateFacts, SayWhyThereAreNone) {
  NormalStudy study;
  study.candidates = {{}, {reading(10)}, {}};
  EXPECT_EQ(why_no_candidates(study, 1), "");
  EXPECT_THAT(why_no_candidates(study, 0), HasSubstr("reference frame"));
  EXPECT_THAT(why_no_candidates(study, 2), HasSubstr("no homography"));
  EXPECT_THAT(why_no_candidates(study, -1), HasSubstr("outside"));
  EXPECT_THAT(why_no_candidates(study, 3), HasSubstr("outside"));
}

}  // namespace
}  // namespace gpo
