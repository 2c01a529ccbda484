// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/window_test.h"

#include <set>

#include <gmock/gmock.h>

namespace gpo {
namespace {

const Question kQuestion{.title = "This session starts commands of its own",
                         .lines = {"mine=python3 mine.py --with %s and a lot of arguments that go "
                                   "on and on so that they do not fit into one line of the window",
                                   "other=rm -r everything"},
                         .advice = "Start them if you know who wrote the session.",
                         .yes = "Start them",
                         .no = "Do not start them"};

class QuestionTest : public DrawingTest {
 protected:
  std::optional<bool> draw() {
    context_.bind();
    return ask(gui_, {1280, 720}, kQuestion);
  }

  OffscreenContext context_{1280, 720};
  Gui gui_;
};

TEST_F(QuestionTest, WaitsForOneOfItsButtons) {
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(draw());
  std::set<bool> answers;
  for (int y = 300; y < 500; y += 10)
    for (int x = 340; x < 940; x += 60) {
      ImGui::GetIO().MousePos = {static_cast<float>(x), static_cast<float>(y)};
      draw();
      ImGui::GetIO().MouseDown[0] = true;
      draw();
      ImGui::GetIO().MouseDown[0] = false;
      const auto answer = draw();
      if (!answer) continue;
      EXPECT_FALSE(answers.empty() && *answer) << "the left button means no";
      answers.insert(*answer);
    }
  EXPECT_EQ(answers, (std::set<bool>{false, true}));
}

TEST_F(QuestionTest, ShowsItsText) {
  for (int i = 0; i < 3; ++i) draw();
  const cv::Mat image = context_.read_bgr();
  keep("question", image);
  cv::Mat gray, different;
  cv::extractChannel(image, gray, 1);
  cv::compare(gray, gray.at<std::uint8_t>(0, 0), different, cv::CMP_NE);
  EXPECT_GT(cv::countNonZero(different), 20'000);
}

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
