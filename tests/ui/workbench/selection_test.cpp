// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/ui/made_inspection.h"
#include "ui/workbench/actions/actions.h"
#include "ui/workbench/session/session_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace gpo {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using Ids = std::vector<std::int64_t>;

WorkbenchState with_inspection() {
  const auto inspection = std::make_shared<const Inspection>(made_inspection());
  WorkbenchState state;
  state.document.settings = inspection->settings;
  apply_recording(state, inspection->recording);
  state.results.inspection = inspection;
  return state;
}

TEST(Selection, KeepsIdsAscendingAndFocusesTheLastOne) {
  Selection selection = selected(Ids{7, 3, 7});
  EXPECT_THAT(selection.tracks, ElementsAre(3, 7));
  EXPECT_EQ(selection.focus, 7);
  selection = toggled(selection, 5);
  EXPECT_THAT(selection.tracks, ElementsAre(3, 5, 7));
  EXPECT_EQ(selection.focus, 5);
  selection = toggled(selection, 5);
  EXPECT_THAT(selection.tracks, ElementsAre(3, 7));
  EXPECT_EQ(selection.focus, 7);
  EXPECT_THAT(inverted(selection, Ids{1, 3, 4, 7}).tracks, ElementsAre(1, 4));
  EXPECT_EQ(toggled(toggled(selection, 3), 7), Selection{});
}

TEST(Selection, RectangleSelectsTheTracksInside) {
  WorkbenchState state = with_inspection();
  const Tracks& tracks = *state.results.inspection->tracks;
  run_line(state, "frame 20");
  run_line(state, "select rectangle 0 0 200 150");
  EXPECT_FALSE(state.selection.tracks.empty());
  for (const std::int64_t id : tracks_in_view(state)) {
    const Eigen::Vector2d at = tracks.raw_px[20 - tracks.start].col(*column_of(tracks, id));
    const bool inside = at.x() >= 0 && at.y() >= 0 && at.x() <= 200 && at.y() <= 150;
    EXPECT_EQ(state.selection.contains(id), inside) << id;
  }
  const std::size_t inside = state.selection.tracks.size();
  run_line(state, "select invert");
  EXPECT_EQ(state.selection.tracks.size(), tracks_in_view(state).size() - inside);
  run_line(state, "select none");
  EXPECT_THAT(state.selection.tracks, IsEmpty());
}

TEST(Selection, IsExcludedAndRestored) {
  WorkbenchState state = with_inspection();
  run_line(state, "select outliers");
  const Ids outliers = state.selection.tracks;
  EXPECT_FALSE(outliers.empty());
  run_line(state, "exclude");
  EXPECT_EQ(state.document.settings.exclude, outliers);
  run_line(state, "undo");
  EXPECT_THAT(state.document.settings.exclude, IsEmpty());
  run_line(state, "redo");
  run_line(state, "include");
  EXPECT_THAT(state.document.settings.exclude, IsEmpty());
  run_line(state, "select none");
  run_action(state, "exclude");
  EXPECT_EQ(state.messages.text, "no track is selected");
}

TEST(Selection, IsEmptyOutsideOfTheWindow) {
  WorkbenchState state = with_inspection();
  run_line(state, "frame 0");  // the window starts at 5
  EXPECT_THAT(tracks_in_view(state), IsEmpty());
  EXPECT_FALSE(tracks_of_window(state).empty());
}

}  // namespace
}  // namespace gpo
