// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

#include <set>

#include <fmt/ranges.h>
#include <gmock/gmock.h>

namespace gpo {
namespace {

std::vector<LayoutInput> sizes() {
  std::vector<LayoutInput> all = {{1280, 720, 1}, {1280, 720, 2}, {800, 500, 2}};
  for (const float scale : {1.0f, 1.25f, 1.5f, 2.0f})
    for (float width = 800; width <= 3840; width += 95)
      for (float height = 500; height <= 2160; height += 83)
        if (width >= 800 * scale && height >= 500 * scale) all.push_back({width, height, scale});
  return all;
}

std::vector<Rectangle> parts(const WindowLayout& l) {
  return {l.menu,
          l.verdict,
          l.settings,
          l.results,
          l.image,
          l.side_tabs,
          l.side,
          l.drawer_tabs,
          l.timeline,
          l.status};
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

std::string name(const LayoutInput& s) {
  return fmt::format("{} x {} at {}", s.width, s.height, s.scale);
}

/// Expects rectangles inside of the window, without overlaps and larger than `width` x `height`.
void expect_disjoint(const std::vector<Rectangle>& all,
                     const LayoutInput& window,
                     float width,
                     float height) {
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_GE(all[i].x, 0) << i;
    ASSERT_GE(all[i].y, 0) << i;
    ASSERT_LE(all[i].right(), window.width) << i;
    ASSERT_LE(all[i].bottom(), window.height) << i;
    ASSERT_GT(all[i].width, width) << i;
    ASSERT_GT(all[i].height, height) << i;
    for (std::size_t j = 0; j < i; ++j) ASSERT_FALSE(overlap(all[i], all[j])) << i << " " << j;
  }
}

TEST(WindowLayout, PartsAreInsideAndDoNotOverlap) {
  for (const LayoutInput& size : sizes()) {
    SCOPED_TRACE(name(size));
    expect_disjoint(parts(window_layout(size)), size, 100, 20);
  }
}

TEST(WindowLayout, TinyWindowKeepsAPixelOfEachPart) {
  for (const bool drawer : {false, true})
    for (LayoutInput size : {LayoutInput{64, 48, 1}, {1, 1, 1}, {200, 900, 2}, {900, 90, 2}}) {
      SCOPED_TRACE(name(size));
      size.drawer_open = drawer;
      const WindowLayout layout = window_layout(size);
      auto all = parts(layout);
      all.insert(all.end(), {layout.views, layout.drawer});
      for (const Rectangle& part : all) {
        EXPECT_GE(part.width, 1);
        EXPECT_GE(part.height, part == layout.drawer && !drawer ? 0 : 1);
      }
    }
}

TEST(WindowLayout, ImageAndSceneAreTheLargest) {
  const auto area = [](const Rectangle& r) { return r.width * r.height; };
  for (const LayoutInput& size : sizes()) {
    SCOPED_TRACE(name(size));
    const WindowLayout layout = window_layout(size);
    const float views = area(layout.image) + area(layout.side);
    if (size.width >= 1280 * size.scale && size.height >= 720 * size.scale) {
      ASSERT_GT(views, size.width * size.height - views);
    }
    const float beside = area(layout.side) + area(layout.side_tabs);
    ASSERT_GE(area(layout.image) / beside, 0.98);
    ASSERT_LE(area(layout.image) / beside, 1.4);
    if (size.width < 800 * size.scale) continue;
    for (const Rectangle& part : {layout.menu, layout.timeline, layout.status})
      ASSERT_GT(area(layout.image), area(part));
  }
}

TEST(WindowLayout, TimeLineAndBarsSpanTheWidth) {
  const WindowLayout layout = window_layout({1280, 720});
  for (const Rectangle& part : {layout.menu, layout.timeline, layout.status}) {
    EXPECT_EQ(part.x, 0);
    EXPECT_EQ(part.width, 1280);
  }
  EXPECT_EQ(layout.status.bottom(), 720);
  EXPECT_EQ(layout.image.y, layout.side_tabs.y);  // side by side
  EXPECT_LE(layout.image.right(), layout.side.x);
}

TEST(WindowLayout, KeepsAllPartsWhereverASplitterIsDragged) {
  for (const Splitter splitter :
       {Splitter::column, Splitter::settings, Splitter::image, Splitter::drawer})
    for (LayoutInput size : {LayoutInput{1280, 720, 1}, {1366, 768, 1}, {2560, 1440, 2}}) {
      SCOPED_TRACE(fmt::format("{}, splitter {}", name(size), static_cast<int>(splitter)));
      size.drawer_open = true;
      const WindowLayout before = window_layout(size);
      for (const float part : {-0.5F, 0.0F, 0.3F, 0.5F, 0.8F, 1.5F}) {
        size.division =
            dragged({}, splitter, before, {part * size.width, part * size.height}, size.scale);
        const WindowLayout layout = window_layout(size);
        auto all = parts(layout);
        all.push_back(layout.drawer);
        expect_disjoint(all, size, 20, 20);
        EXPECT_EQ(automatic(size.division, splitter), Division{});
      }
    }
}

TEST(WindowLayout, SplitterIsWhereItIsDraggedTo) {
  for (const float scale : {1.0F, 2.0F}) {
    const auto line = [&](Splitter splitter, DragPoint to) {
      LayoutInput input{.width = 1600, .height = 1000, .scale = scale, .drawer_open = true};
      input.division = dragged({}, splitter, window_layout(input), to, scale);
      return place_of(splitter, window_layout(input), scale);
    };
    EXPECT_NEAR(line(Splitter::column, {500, 0}).x, 500, 1);
    EXPECT_NEAR(line(Splitter::settings, {0, 400}).y, 400, 2);
    EXPECT_NEAR(line(Splitter::image, {900, 400}).x, 900, 2);
    EXPECT_NEAR(line(Splitter::drawer, {900, 450}).y, 450, 2);
  }
}

TEST(WindowLayout, MaximizesOnePartAndHidesTheOthers) {
  LayoutInput input{.width = 1280, .height = 720, .drawer_open = true};
  const WindowLayout whole = window_layout(input);
  input.scan = true;
  EXPECT_EQ(window_layout(input).timeline.height, whole.timeline.height + kScanHeight);
  input.scan = false;
  const auto with = [&](WindowPart part) {
    input.division.maximized = part;
    return window_layout(input);
  };
  EXPECT_EQ(with(WindowPart::image).image.width, 1280);
  EXPECT_TRUE(with(WindowPart::image).side.empty());
  EXPECT_TRUE(with(WindowPart::image).settings.empty());
  EXPECT_EQ(with(WindowPart::side).side.width, 1280);
  EXPECT_TRUE(with(WindowPart::side).image.empty());
  EXPECT_EQ(with(WindowPart::drawer).drawer.width, 1280);
  EXPECT_NEAR(with(WindowPart::drawer).drawer.bottom(), whole.timeline.y, 1);
  EXPECT_TRUE(with(WindowPart::drawer).views.empty());
  const WindowLayout bare = window_layout(
      {.width = 1280, .height = 720, .division = {.column = false, .timeline = false}});
  EXPECT_EQ(bare.views.x, 0);
  EXPECT_TRUE(bare.timeline.empty());
  EXPECT_GT(bare.views.bottom(), whole.timeline.y);
}

TEST(WindowLayout, TwoDrawersShareThePlaceOfOne) {
  LayoutInput input{.width = 1366, .height = 768, .drawer_open = true};
  const WindowLayout one = window_layout(input);
  input.beside_open = true;
  const WindowLayout two = window_layout(input);
  EXPECT_TRUE(one.beside.empty());
  EXPECT_EQ(two.drawer.x, one.drawer.x);
  EXPECT_EQ(two.beside.right(), one.drawer.right());
  EXPECT_NEAR(two.drawer.width, two.beside.width, 2);
  EXPECT_EQ(two.beside.height, one.drawer.height);
  EXPECT_FALSE(overlap(two.drawer, two.beside));
  input.drawer_open = false;
  EXPECT_TRUE(window_layout(input).beside.empty());
}

TEST(WindowLayout, BannerOfAFailureTakesItsHeightFromTheViews) {
  LayoutInput input{.width = 1366, .height = 768};
  const WindowLayout whole = window_layout(input);
  input.failed = true;
  const WindowLayout failed = window_layout(input);
  EXPECT_TRUE(whole.banner.empty());
  EXPECT_EQ(failed.banner.y, whole.views.y);
  EXPECT_EQ(failed.views.y, failed.banner.bottom());
  EXPECT_EQ(failed.drawer_tabs, whole.drawer_tabs);
  EXPECT_EQ(failed.settings, whole.settings);
}

TEST(WindowLayout, SettingsAreAsHighAsTheirContentIfTheResultsHaveRoom) {
  LayoutInput input{.width = 1366, .height = 768, .verdict_height = 100, .settings_height = 240};
  const WindowLayout layout = window_layout(input);
  EXPECT_EQ(layout.verdict.height, 100);
  EXPECT_EQ(layout.settings.y, layout.verdict.bottom());
  EXPECT_EQ(layout.settings.height, 240);
  input.settings_height = 2000;
  EXPECT_GE(window_layout(input).results.height, 165);
}

TEST(WindowLayout, DoublesWithTheContentScale) {
  const auto one = parts(window_layout({1280, 720, 1}));
  const auto two = parts(window_layout({2560, 1440, 2}));
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(two[i].x, 2 * one[i].x, 2);
    EXPECT_NEAR(two[i].width, 2 * one[i].width, 2);
    EXPECT_NEAR(two[i].height, 2 * one[i].height, 2);
  }
}

TEST(WorkbenchPanes, HaveTheKeysOfSessionsAndScripts) {
  std::vector<std::string> sides;
  for (const Pane& pane : side_panes()) sides.push_back(pane.key);
  EXPECT_THAT(sides, testing::ElementsAre("scene", "normals", "solver", "candidates"));
  EXPECT_EQ(fmt::format("{}", fmt::join(pane_names(), " ")),
            "image picture scene normals solver candidates compare curves table residuals timing "
            "track tracks camera log window");
  EXPECT_EQ(panes().size(), 3 + side_panes().size() + drawers().size());
  EXPECT_EQ(find_pane("picture"), find_pane("image"));
  EXPECT_EQ(find_pane(""), nullptr);
  EXPECT_EQ(find_pane("image", side_panes()), nullptr);
  EXPECT_EQ(find_pane("scene", drawers()), nullptr);
  EXPECT_EQ(find_pane("cellar", side_panes()), nullptr);
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
      const bool below = find_pane(pane.key, drawers()) != nullptr;
      EXPECT_EQ(below ? state.view.panes.drawer : state.view.panes.side, &pane);
      EXPECT_EQ(state.view.panes.compare, below) << pane.key;
    }
  EXPECT_THROW(action_named("view cellar"), std::logic_error);
}

TEST(WorkbenchPanes, NeedsFollowTheOpenViews) {
  Panes panes;
  EXPECT_FALSE(needs_of(panes).compared);
  EXPECT_FALSE(needs_of(panes).study);
  panes.side = find_pane("normals", side_panes());
  EXPECT_TRUE(needs_of(panes).study);
  EXPECT_TRUE(needs_of(panes).compared);
  panes.compare = true;
  EXPECT_FALSE(needs_of(panes).study) << "the columns replace the side pane";
  panes = {};
  panes.drawer = find_pane("curves", drawers());
  EXPECT_TRUE(needs_of(panes).lengths);
  panes.drawer = find_pane("log", drawers());
  EXPECT_FALSE(needs_of(panes).compared);
}

}  // namespace
}  // namespace gpo
