// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/window/window.h"
#include "ui/panels/facts/candidate_facts.h"

#include <gmock/gmock.h>

namespace gpo {
namespace {

TEST(StudyFacts, SayWhyThereIsNoneToLookAt) {
  WorkbenchState state;
  EXPECT_EQ(why_no_study(state, "computing"), "computing");
  Inspection inspection;
  inspection.window = std::make_shared<const Window>();
  state.results.inspection = std::make_shared<const Inspection>(inspection);
  EXPECT_EQ(why_no_study(state, "computing"), "computing");
  NormalStudy study;
  study.window = inspection.window;
  state.results.study = std::make_shared<const NormalStudy>(study);
  EXPECT_EQ(why_no_study(state, "computing"), "");
  study.error = "no memory";
  state.results.study = std::make_shared<const NormalStudy>(study);
  EXPECT_THAT(why_no_study(state, "computing"), testing::HasSubstr("no memory"));
  study.window = std::make_shared<const Window>();
  state.results.study = std::make_shared<const NormalStudy>(study);
  EXPECT_EQ(why_no_study(state, "computing"), "computing") << "of another window";
}

}  // namespace
}  // namespace gpo
