// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/configuration.h"
#include "tests/ui/made_inspection.h"
#include "ui/workbench/compared.h"

#include <gtest/gtest.h>

namespace gpo {
namespace {

TEST(ShownResults, AreTheCurrentOneAndTheComparedOnesThatExist) {
  WorkbenchState state;
  EXPECT_TRUE(shown_results(state).empty());
  Inspection made = made_inspection();
  made.settings.options.method = "gpo";
  const auto current = std::make_shared<const Inspection>(made);
  state.results.inspection = current;
  state.document.compared = parse_configurations("gpo,ba,gpo+no-ransac");
  const Settings& settings = current->settings;
  SurveyResults surveyed;
  for (const char* key : {"gpo", "gpo+no-ransac"})
    surveyed.push_back({apply(parse_configuration(key), settings), current, ""});
  Settings shorter = apply(parse_configuration("ba"), settings);
  --shorter.frames;
  surveyed.push_back({shorter, current, ""});
  surveyed.push_back({apply(parse_configuration("ba"), settings), nullptr, "does not work"});
  state.results.surveyed = std::make_shared<const SurveyResults>(surveyed);
  const auto shown = shown_results(state);
  ASSERT_EQ(shown.size(), 2U) << "ba is known of another window only";
  EXPECT_TRUE(shown[0].current);
  EXPECT_EQ(shown[0].name, "GPO");
  EXPECT_FALSE(shown[1].current);
  EXPECT_EQ(shown[1].name, title_of(parse_configuration("gpo+no-ransac")));
  EXPECT_EQ(shown[1].rgb, color_of(parse_configuration("gpo+no-ransac")));
}

}  // namespace
}  // namespace gpo
