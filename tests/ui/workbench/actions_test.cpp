// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/methods.h"
#include "tests/engine/test_folder.h"
#include "tests/ui/window_test.h"

#include <set>

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

using test::refusal, test::run_lines, testing::ElementsAre, testing::HasSubstr, testing::IsEmpty;
using Ids = std::vector<std::int64_t>;

TEST(Actions, HaveUniqueNamesAndKeysAndTooltips) {
  std::set<std::string> names, labels;
  for (const Action& action : actions()) {
    EXPECT_TRUE(names.insert(action.name).second) << action.name;
    EXPECT_FALSE(action.title.empty()) << action.name;
    EXPECT_FALSE(action.tooltip.empty()) << action.name;
    ASSERT_TRUE(action.run) << action.name;
    if (action.takes_keys) continue;  // instead of another action
    for (const Shortcut& shortcut : action.shortcuts)
      EXPECT_TRUE(labels.insert(shortcut.label).second) << shortcut.label;
  }
}

TEST(Palette, FindsActionsBySynonymsAndHelpTexts) {
  const auto finds = [](const std::string& text, const std::string& name) {
    const std::vector<Action> found = find_actions(text, {});
    return std::ranges::find(found, name, &Action::name) != found.end();
  };
  EXPECT_TRUE(finds("scale", "metric"));
  EXPECT_TRUE(finds("measure", "select track"));
  EXPECT_TRUE(finds("distance", "select track"));
  EXPECT_TRUE(finds("horizon", "gravity"));
  EXPECT_TRUE(finds("origin", "put-cube"));
  EXPECT_TRUE(finds("report", "export result"));
  EXPECT_TRUE(finds("why rejected", "explain-track"));
  EXPECT_FALSE(finds("no such word", "metric"));
  EXPECT_EQ(find_actions("bookmark", {}).front().name, "bookmark") << "names come first";
}

TEST(Panes, TwoDrawersAreOpenSideBySide) {
  WorkbenchState state;
  Panes& panes = state.view.panes;
  run_line(state, "view curves");
  run_line(state, "view-beside table");
  EXPECT_EQ(panes.drawer, find_pane("curves"));
  EXPECT_EQ(panes.beside, find_pane("table"));
  EXPECT_TRUE(needs_of(panes).lengths && needs_of(panes).compared);
  run_line(state, "view table");
  EXPECT_EQ(panes.drawer, find_pane("table"));
  EXPECT_EQ(panes.beside, nullptr) << "no drawer is open twice";
  run_line(state, "view-beside log");
  close_next(state);
  EXPECT_EQ(panes.beside, nullptr);
  EXPECT_NE(panes.drawer, nullptr);
  EXPECT_EQ(test::refusal(state, "view-beside scene"),
            "view-beside: 'scene', expected off or one of curves, table, residuals, timing, track, "
            "tracks, camera, log");
  run_line(state, "view no-drawer");
  run_line(state, "view-beside log");
  EXPECT_EQ(panes.drawer, find_pane("log")) << "the only drawer is the first one";
}

TEST(Help, HasPagesAndATourOfThreeSteps) {
  WorkbenchState state;
  for (const char* page : {"help", "glossary", "manual", "findings", "about"}) {
    run_line(state, page);
    EXPECT_TRUE(state.view.show_help && action_named(page).checked(state)) << page;
  }
  run_line(state, "about");
  EXPECT_FALSE(state.view.show_help) << "the same page again closes the help";
  for (const int step : {1, 2, 3, 0}) {
    run_line(state, "tour");
    EXPECT_EQ(state.view.tour, step);
  }
  run_line(state, "tour 2");
  run_line(state, "escape");
  EXPECT_EQ(state.view.tour, 0);
  EXPECT_EQ(test::refusal(state, "tour 4"), "tour: '4', expected 1 to 3 or off");
}

TEST(Script, HasCommentsOnlyAtTheBeginningOfAWord) {
  const test::TestFolder folder;
  const auto lines = read_script(folder.write("a.script",
                                              "# first\n"
                                              "open desk#1 # which\n"
                                              "open \"my desk #2\"\n"
                                              "copy \"a \\\" # b\" # c\n"));
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].text, "open desk#1 ");
  EXPECT_EQ(lines[1].text, "open \"my desk #2\"");
  EXPECT_EQ(lines[2].text, "copy \"a \\\" # b\" ");
}

TEST(Actions, ReadArgumentsAndReportInvalidOnes) {
  auto recording = std::make_shared<Recording>();
  for (int i = 0; i < 60; ++i) recording->timestamps_ns.push_back(100'000'000LL * i);
  WorkbenchState state;
  apply_recording(state, recording);
  const Settings& settings = state.document.settings;
  run_lines(state, "frame 40; method pba; set seed 7; exaggerate; point-size 9; color-by residual");
  run_lines(state, "viewpoint top; tails off; ransac_threshold_px 2.5");  // also without "set"
  EXPECT_EQ(state.view.frame, 40);
  EXPECT_EQ(settings.options.method, "pba");
  EXPECT_EQ(settings.options.seed, 7u);
  EXPECT_EQ(settings.options.ransac_threshold_px, 2.5);
  EXPECT_EQ(state.view.toggles.exaggeration, 5);
  EXPECT_EQ(state.view.toggles.point_size_px, 9);
  EXPECT_EQ(state.view.coloring, Coloring::residual);
  EXPECT_EQ(state.view.viewpoint, Viewpoint::top);
  EXPECT_FALSE(state.view.toggles.tails);
  run_lines(state, "exaggerate 100; exaggerate");
  EXPECT_EQ(state.view.toggles.exaggeration, 1);
  for (const auto& [line, message] :
       {std::pair{"frame", "frame: expected N"},
        {"frame x", "frame: 'x', expected a number"},
        {"frame 1 2", "frame: unexpected argument '2'"},
        {"frame 60", "frame: 60 is outside of the recording, expected 0 to 59"},
        {"exaggerate 2", "exaggerate: '2', expected one of 1, 5, 20, 100"},
        {"point-size 30", "point-size: '30', expected 1 to 20"},
        {"method nobody", "method: unknown value 'nobody', expected one of gpo"},
        {"start x", "start: 'x', expected"},
        {"start 0 1", "start: unexpected argument '1'"},
        {"speed 99", "speed: '99', expected 0.05 to 20"},
        {"text-size 2", "text-size: '2', expected 50 to 300"},
        {"zoom 100", "zoom: '100', expected 1 to 64"},
        {"mask foo 1 2 3 4", "mask: 'foo', expected one of not, plane, off"},
        {"theme pink", "theme: 'pink', expected one of "},
        {"view", "view: expected one of "},
        {"nobody 3", "unknown command \"nobody\"; Ctrl+P lists all commands"},
        {"set seed -1", "seed: '-1', expected a whole number from 0 to 1e+09"},
        {"set colour red", "unknown setting 'colour'"},
        {"tails perhaps", "tails: 'perhaps', expected on or off"},
        {"screenshot a.jpg", "screenshot: 'a.jpg', expected a file name that ends in .png"},
        {"select track 7", "select track: the window has no track 7"}}) {
    run_action(state, line);
    EXPECT_THAT(state.messages.text, testing::HasSubstr(message)) << line;
  }
}

TEST(Actions, FindsActionsByKeyAndCharacter) {
  const auto of_key = [](int glfw_key, bool shift = false, bool control = false) -> std::string {
    const Action* action = action_of_key(glfw_key, shift, control);
    return action == nullptr ? "" : action->name;
  };
  EXPECT_EQ(of_key(GLFW_KEY_LEFT), "previous");
  EXPECT_EQ(of_key(GLFW_KEY_RIGHT), "next");
  EXPECT_EQ(of_key(GLFW_KEY_LEFT, true), "previous-ten");
  EXPECT_EQ(of_key(GLFW_KEY_RIGHT, true), "next-ten");
  EXPECT_EQ(of_key(GLFW_KEY_HOME), "first");
  EXPECT_EQ(of_key(GLFW_KEY_END), "last");
  EXPECT_EQ(of_key(GLFW_KEY_F1), "help");
  EXPECT_EQ(of_key(GLFW_KEY_ESCAPE), "escape");
  EXPECT_EQ(of_key(GLFW_KEY_Q, false, true), "quit");
  EXPECT_EQ(of_key(GLFW_KEY_Q), "");
  EXPECT_EQ(of_key(GLFW_KEY_UNKNOWN), "");
  std::string names;
  for (const char32_t character : std::u32string(U" []tTebgrfs?1")) {
    ASSERT_NE(action_of_character(character), nullptr) << names;
    names += action_of_character(character)->name + ", ";
  }
  EXPECT_EQ(names,
            "play, window-start, window-end, tails, tails, residuals, cube, truth, ransac, fit, "
            "save-picture, help, method gpo, ");
  EXPECT_EQ(action_of_character(U'\u00e4'), nullptr);
}

WorkbenchState with_inspection() {
  WorkbenchState state;
  test::open(state, test::shared_inspection());
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
  run_lines(state, "frame 20; select rectangle 0 0 200 150");
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
  EXPECT_THAT(state.messages.text, HasSubstr("Ctrl+Z undoes it"));
  run_line(state, "undo");
  EXPECT_THAT(state.document.settings.exclude, IsEmpty());
  EXPECT_EQ(state.messages.text, "");
  run_lines(state, "redo; include");
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
