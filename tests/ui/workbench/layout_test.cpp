// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/layout.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace gpo {
namespace {

struct Size {
  float width, height, scale;
};

std::vector<Size> sizes() {
  std::vector<Size> all;
  for (const float scale : {1.0f, 1.25f, 1.5f, 2.0f}) {
    for (float width = 800; width <= 3840; width += 95) {
      for (float height = 500; height <= 2160; height += 83) {
        if (width >= 800 * scale && height >= 500 * scale) all.push_back({width, height, scale});
      }
    }
  }
  all.insert(all.end(), {{800, 500, 1}, {1280, 720, 1}, {1280, 720, 2}, {800, 500, 2}});
  return all;
}

std::vector<Rectangle> parts(const WindowLayout& l) {
  return {l.menu,
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

std::string name(const Size& s) {
  return std::to_string(s.width) + "x" + std::to_string(s.height) + " at " +
         std::to_string(s.scale);
}

TEST(WindowLayout, PartsLieInsideAndDoNotOverlap) {
  for (const Size& size : sizes()) {
    SCOPED_TRACE(name(size));
    const auto all = parts(window_layout(size.width, size.height, size.scale, {}, false));
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_GE(all[i].x, 0);
      ASSERT_GE(all[i].y, 0);
      ASSERT_LE(all[i].right(), size.width);
      ASSERT_LE(all[i].bottom(), size.height);
      ASSERT_GT(all[i].width, 100);
      ASSERT_GT(all[i].height, 20);
      for (std::size_t j = 0; j < i; ++j) ASSERT_FALSE(overlap(all[i], all[j])) << i << " " << j;
    }
  }
}

TEST(WindowLayout, APixelIsLeftOfEachPart) {
  for (const bool drawer : {false, true}) {
    for (const Size& size : {Size{64, 48, 1}, Size{1, 1, 1}, Size{200, 900, 2}, Size{900, 90, 2}}) {
      SCOPED_TRACE(name(size));
      const WindowLayout layout = window_layout(size.width, size.height, size.scale, {}, drawer);
      auto all = parts(layout);
      all.insert(all.end(), {layout.views, layout.drawer});
      for (const Rectangle& part : all) {
        EXPECT_GE(part.width, 1);
        EXPECT_GE(part.height, part == layout.drawer && !drawer ? 0 : 1);
      }
    }
  }
}

TEST(WindowLayout, ImageAndSceneAreTheLargest) {
  for (const Size& size : sizes()) {
    SCOPED_TRACE(name(size));
    const WindowLayout layout = window_layout(size.width, size.height, size.scale, {}, false);
    const auto area = [](const Rectangle& r) { return r.width * r.height; };
    const float views = area(layout.image) + area(layout.side);
    const float others = size.width * size.height - views;
    if (size.width >= 1280 * size.scale && size.height >= 720 * size.scale) {
      ASSERT_GT(views, others);
    }
    const float beside = area(layout.side) + area(layout.side_tabs);
    ASSERT_GE(area(layout.image) / beside, 0.98);
    ASSERT_LE(area(layout.image) / beside, 1.4);
    if (size.width < 800 * size.scale) continue;
    for (const Rectangle& part : {layout.menu, layout.timeline, layout.status}) {
      ASSERT_GT(area(layout.image), area(part));
    }
  }
}

TEST(WindowLayout, TimeLineAndBarsSpanTheWidth) {
  const WindowLayout layout = window_layout(1280, 720, 1, {}, false);
  for (const Rectangle& part : {layout.menu, layout.timeline, layout.status}) {
    EXPECT_EQ(part.x, 0);
    EXPECT_EQ(part.width, 1280);
  }
  EXPECT_EQ(layout.status.bottom(), 720);
  EXPECT_EQ(layout.image.y, layout.side_tabs.y);  // side by side
  EXPECT_LE(layout.image.right(), layout.side.x);
}

// Whatever the user drags where: parts stay inside, apart and large enough to be dragged back.
TEST(WindowLayout, KeepsItsPartsWhereverALineIsDragged) {
  for (const Splitter splitter :
       {Splitter::column, Splitter::settings, Splitter::image, Splitter::drawer}) {
    for (const Size& size : {Size{1280, 720, 1}, Size{1366, 768, 1}, Size{2560, 1440, 2}}) {
      SCOPED_TRACE(name(size) + ", line " + std::to_string(static_cast<int>(splitter)));
      const WindowLayout before = window_layout(size.width, size.height, size.scale, {}, true);
      for (const float part : {-0.5F, 0.0F, 0.3F, 0.5F, 0.8F, 1.5F}) {
        const Division division =
            dragged({}, splitter, before, part * size.width, part * size.height, size.scale);
        const WindowLayout layout =
            window_layout(size.width, size.height, size.scale, division, true);
        auto all = parts(layout);
        all.push_back(layout.drawer);
        for (std::size_t i = 0; i < all.size(); ++i) {
          EXPECT_GE(all[i].x, 0);
          EXPECT_LE(all[i].right(), size.width);
          EXPECT_LE(all[i].bottom(), size.height);
          EXPECT_GT(all[i].width, 20) << i;
          EXPECT_GT(all[i].height, 20) << i;
          for (std::size_t j = 0; j < i; ++j)
            EXPECT_FALSE(overlap(all[i], all[j])) << i << " " << j;
        }
        EXPECT_EQ(automatic(division, splitter), Division{});
      }
    }
  }
}

TEST(WindowLayout, PutsALineWhereItIsDraggedTo) {
  for (const float scale : {1.0F, 2.0F}) {
    const WindowLayout before = window_layout(1600, 1000, scale, {}, true);
    const auto line = [&](Splitter splitter, float x, float y) {
      const Division division = dragged({}, splitter, before, x, y, scale);
      return place_of(splitter, window_layout(1600, 1000, scale, division, true), scale);
    };
    EXPECT_NEAR(line(Splitter::column, 500, 0).x, 500, 1);
    EXPECT_NEAR(line(Splitter::settings, 0, 400).y, 400, 2);
    EXPECT_NEAR(line(Splitter::image, 900, 400).x, 900, 2);
    EXPECT_NEAR(line(Splitter::drawer, 900, 450).y, 450, 2);
  }
}

TEST(WindowLayout, GivesOnePartAllOfItAndHidesTheOthers) {
  EXPECT_EQ(window_layout(1280, 720, 1, {}, true, true).timeline.height,
            window_layout(1280, 720, 1, {}, true).timeline.height + kScanHeight);
  const float below = window_layout(1280, 720, 1, {}, true).timeline.y;
  const auto with = [](WindowPart part) {
    Division division;
    division.maximized = part;
    return window_layout(1280, 720, 1, division, true);
  };
  EXPECT_EQ(with(WindowPart::image).image.width, 1280);
  EXPECT_TRUE(with(WindowPart::image).side.empty());
  EXPECT_TRUE(with(WindowPart::image).settings.empty());
  EXPECT_EQ(with(WindowPart::side).side.width, 1280);
  EXPECT_TRUE(with(WindowPart::side).image.empty());
  EXPECT_EQ(with(WindowPart::drawer).drawer.width, 1280);
  EXPECT_NEAR(with(WindowPart::drawer).drawer.bottom(), below, 1);
  EXPECT_TRUE(with(WindowPart::drawer).views.empty());
  const WindowLayout bare =
      window_layout(1280, 720, 1, {.column = false, .timeline = false}, false);
  EXPECT_EQ(bare.views.x, 0);
  EXPECT_TRUE(bare.timeline.empty());
  EXPECT_GT(bare.views.bottom(), below);
}

TEST(WindowLayout, DoublesWithTheContentScale) {
  const auto one = parts(window_layout(1280, 720, 1, {}, false));
  const auto two = parts(window_layout(2560, 1440, 2, {}, false));
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_NEAR(two[i].x, 2 * one[i].x, 2);
    EXPECT_NEAR(two[i].width, 2 * one[i].width, 2);
    EXPECT_NEAR(two[i].height, 2 * one[i].height, 2);
  }
}

}  // namespace
}  // namespace gpo
