// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::IsSupersetOf;

TEST(WorkbenchPanes, HaveTheKeysOfSessionsAndScripts) {
  std::vector<std::string> sides;
  for (const Pane& pane : side_panes()) sides.push_back(pane.key);
  EXPECT_THAT(sides, testing::ElementsAre("scene", "normals", "solver", "candidates"));
  EXPECT_THAT(pane_names(),
              IsSupersetOf({"window",
                            "image",
                            "picture",
                            "compare",
                            "normals",
                            "curves",
                            "table",
                            "residuals",
                            "timing",
                            "track",
                            "log"}));
  EXPECT_EQ(panes().size(), 3 + side_panes().size() + drawers().size());
  EXPECT_EQ(find_pane("picture"), find_pane("image"));
  EXPECT_EQ(find_pane(""), nullptr);
  EXPECT_EQ(find_side_pane("image"), nullptr);
  EXPECT_EQ(find_drawer("scene"), nullptr);
  EXPECT_EQ(find_side_pane("cellar"), nullptr);
}

TEST(WorkbenchPanes, EachIsOpenedByItsOwnAction) {
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
  EXPECT_THROW(action_named("view cellar"), std::logic_error);
}

TEST(WorkbenchPanes, NeedsFollowTheOpenViews) {
  Panes panes;
  EXPECT_FALSE(needs_of(panes).compared);
  EXPECT_FALSE(needs_of(panes).study);
  panes.side = find_side_pane("normals");
  EXPECT_TRUE(needs_of(panes).study);
  EXPECT_TRUE(needs_of(panes).compared);
  panes.compare = true;
  EXPECT_FALSE(needs_of(panes).study) << "the columns replace the side pane";
  panes = {};
  panes.drawer = find_drawer("curves");
  EXPECT_TRUE(needs_of(panes).lengths);
  panes.drawer = find_drawer("log");
  EXPECT_FALSE(needs_of(panes).compared);
}

}  // namespace
}  // namespace gpo
