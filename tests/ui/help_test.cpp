// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/window_test.h"
#include "ui/panels/panels.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

TEST(Glossary, ExplainsEachTermOnce) {
  std::set<std::string> terms;
  for (const auto& [term, meaning] : glossary()) {
    EXPECT_TRUE(terms.insert(term).second) << term;
    EXPECT_THAT(meaning, testing::EndsWith(".")) << term;
  }
  EXPECT_EQ(terms.size(), 30U);
  EXPECT_THAT(terms, testing::IsSupersetOf({"verdict", "baseline |t| [d]", "cube anchor"}));
}

class HelpOverlay : public test::WindowTest {};

TEST_F(HelpOverlay, ShowsKeysFirstAndTheGlossaryOnRequest) {
  open(made_inspection());
  state_.view.show_help = true;
  for (int i = 0; i < 3; ++i) draw();
  const cv::Mat keys = context_.read_bgr();
  views_->glossary = true;
  for (int i = 0; i < 3; ++i) draw();
  const cv::Mat terms = context_.read_bgr();
  keep("glossary", terms);
  EXPECT_FALSE(same_bytes(keys, terms));
  state_.view.show_help = false;
  draw();
  EXPECT_FALSE(views_->glossary);
}

TEST_F(HelpOverlay, ClosesOnAClickBesideIt) {
  open(made_inspection());
  state_.view.show_help = true;
  draw();
  EXPECT_EQ(test::line_of(click(20, 400)), "escape");
}

}  // namespace
}  // namespace gpo
