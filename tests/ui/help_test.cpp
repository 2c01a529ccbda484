// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/window_test.h"
#include "ui/panels/panels.h"

#include <fstream>

#include <gmock/gmock.h>

namespace gpo {
namespace {

/// Returns the rows of ui/GLOSSARY.md.
std::vector<std::string> rows_of_page() {
  std::ifstream page(GPO_SOURCE_DIR "/ui/GLOSSARY.md");
  std::vector<std::string> rows;
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("| ") && !line.starts_with("| term |") && !line.starts_with("| --- |"))
      rows.push_back(line);
  return rows;
}

TEST(Glossary, EqualsItsPage) {
  std::vector<std::string> rows;
  for (const GlossaryTerm& one : glossary())
    rows.push_back("| " + std::string(one.term) + " | " + one.meaning + " |");
  std::vector<std::string> page = rows_of_page();
  for (std::string& row : page) std::erase(row, '\\');  // escaped bars
  EXPECT_EQ(page, rows);
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
