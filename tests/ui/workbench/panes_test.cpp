// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/panes.h"

#include "ui/panels/panels.h"
#include "ui/workbench/actions/actions.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

std::vector<std::string> keys_of(std::span<const Pane> panes) {
  std::vector<std::string> keys;
  for (const Pane& pane : panes) keys.push_back(pane.key);
  return keys;
}

TEST(WorkbenchPanes, HaveTheKeysThatSessionsAndScriptsKnow) {
  EXPECT_THAT(keys_of(side_panes()),
              testing::ElementsAre("scene", "normals", "solver", "candidates"));
  EXPECT_THAT(keys_of(drawers()),
              testing::IsSupersetOf({"curves", "table", "residuals", "timing", "track", "log"}));
}

TEST(WorkbenchPanes, AreOpenedByAnActionEachAndToldApart) {
  std::set<std::string> keys;
  for (const auto& panes : {side_panes(), drawers()})
    for (const Pane& pane : panes) {
      EXPECT_TRUE(keys.insert(pane.key).second) << pane.key;
      EXPECT_NE(draw_function(pane), nullptr) << pane.key;
      const Action& action = action_named(std::string("view ") + pane.key);
      EXPECT_EQ(action.title, pane.title);
      EXPECT_EQ(action.tooltip, pane.tooltip);
      WorkbenchState state;
      run_line(state, "view compare");
      run_line(state, action.name);
      EXPECT_TRUE(action.checked(state)) << pane.key;
      const bool below = find_drawer(pane.key) != nullptr;
      EXPECT_EQ(below ? state.view.panes.drawer : state.view.panes.side, &pane);
      EXPECT_EQ(state.view.panes.compare, below) << pane.key;
    }
  EXPECT_EQ(find_drawer("scene"), nullptr);
  EXPECT_EQ(find_side_pane("cellar"), nullptr);
}

TEST(WorkbenchPanes, AreAllInOneTableAndTheImageHasTwoNames) {
  EXPECT_EQ(panes().size(), 3 + side_panes().size() + drawers().size());
  EXPECT_THAT(pane_names(),
              testing::IsSupersetOf({"window", "image", "picture", "compare", "normals", "log"}));
  EXPECT_EQ(find_pane("picture"), find_pane("image"));
  EXPECT_EQ(find_pane(""), nullptr);
  EXPECT_EQ(find_side_pane("image"), nullptr);
}

TEST(WorkbenchPanes, NeedWhatTheyShow) {
  Panes panes;
  EXPECT_FALSE(needs_of(panes).compared);
  EXPECT_FALSE(needs_of(panes).study);
  panes.side = find_side_pane("normals");
  EXPECT_TRUE(needs_of(panes).study);
  EXPECT_TRUE(needs_of(panes).compared);
  panes.compare = true;
  EXPECT_FALSE(needs_of(panes).study) << "the columns stand in its place";
  panes = {};
  panes.drawer = find_drawer("curves");
  EXPECT_TRUE(needs_of(panes).lengths);
  panes.drawer = find_drawer("log");
  EXPECT_FALSE(needs_of(panes).compared);
}

TEST(WorkbenchPanes, ANameThatNoActionHasIsABugThatIsNamed) {
  EXPECT_THROW(action_named("view cellar"), std::logic_error);
}

}  // namespace
}  // namespace gpo
