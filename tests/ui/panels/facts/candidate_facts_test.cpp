// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/facts/candidate_facts.h"

#include "engine/geometry/pose.h"
#include "engine/window/window.h"

#include <cmath>

#include <gmock/gmock.h>

namespace gpo {
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
