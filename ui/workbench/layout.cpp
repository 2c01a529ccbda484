// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/layout.h"

#include <algorithm>
#include <cmath>

namespace gpo {

namespace {

// At scale 1.
constexpr float kPictureShare =
    0.57F;  // of the views' width: a picture fills it, a scene is mostly empty
constexpr float kMenuHeight = 26;
constexpr float kStatusHeight = 26;
constexpr float kTimelineHeight = 76;
constexpr float kSettingsHeight = 266;
constexpr float kColumnWidth = 292;
constexpr float kLeastResultsHeight = 206;
constexpr float kTabsHeight = 26;
constexpr float kDrawerShare = 0.36F;  // of the views' height
constexpr float kLeastDrawerHeight = 170;
constexpr float kMostDrawerHeight = 420;

float scaled(float length, float scale) { return std::round(length * scale); }

/// Takes the drawer off the lower end of the views.
void put_drawer(WindowLayout& layout, float scale, bool open) {
  Rectangle& views = layout.views;
  const float tabs = scaled(kTabsHeight, scale);
  const float wanted = std::clamp(views.height * kDrawerShare,
                                  scaled(kLeastDrawerHeight, scale),
                                  scaled(kMostDrawerHeight, scale));
  const float height = open ? std::round(std::min(wanted, views.height * 0.5F)) : 0;
  views.height -= tabs + height;
  layout.drawer_tabs = {views.x, views.bottom(), views.width, tabs};
  layout.drawer = {views.x, layout.drawer_tabs.bottom(), views.width, height};
}

/// Picture and side pane within the views.
void put_panes(WindowLayout& layout, float scale, float gap) {
  const Rectangle& views = layout.views;
  const float tabs = scaled(kTabsHeight, scale);
  Rectangle side = layout.picture = views;
  if (views.width >= 1.2f * views.height) {
    layout.picture.width = std::round((views.width - gap) * kPictureShare);
    side.x = layout.picture.right() + gap;
    side.width = views.right() - side.x;
  } else {
    layout.picture.height = std::round((views.height - gap) / 2);
    side.y = layout.picture.bottom() + gap;
    side.height = views.bottom() - side.y;
  }
  layout.side_tabs = {side.x, side.y, side.width, tabs};
  layout.side = {side.x, side.y + tabs, side.width, side.height - tabs};
}

/// In a window smaller than its bars a pixel is left of what lies between them.
void keep_a_pixel(WindowLayout& layout, bool drawer_open) {
  for (Rectangle* part : {&layout.settings,
                          &layout.results,
                          &layout.views,
                          &layout.picture,
                          &layout.side_tabs,
                          &layout.side,
                          &layout.drawer_tabs,
                          &layout.drawer,
                          &layout.timeline}) {
    part->width = std::max(part->width, 1.0F);
    if (part != &layout.drawer || drawer_open) part->height = std::max(part->height, 1.0F);
  }
}

}  // namespace

WindowLayout window_layout(float width, float height, float scale, bool drawer_open) {
  // A window too small for its scale shrinks the fixed parts rather than the pictures to nothing.
  const float column = std::min(scaled(kColumnWidth, scale), std::round(width * 0.38f));
  const float menu = scaled(kMenuHeight, scale);
  const float status = scaled(kStatusHeight, scale);
  const float timeline = std::min(scaled(kTimelineHeight, scale), std::round(height * 0.2f));
  const float gap = std::max(1.0f, scaled(1, scale));

  WindowLayout layout;
  layout.menu = {0, 0, width, menu};
  layout.status = {0, height - status, width, status};
  layout.timeline = {0, layout.status.y - timeline, width, timeline};
  const float top = menu;
  const float bottom = layout.timeline.y - gap;

  const float settings = std::min(scaled(kSettingsHeight, scale),
                                  std::round((bottom - top) - scaled(kLeastResultsHeight, scale)));
  layout.settings = {0, top, column, std::max(settings, std::round((bottom - top) / 2))};
  layout.settings.height = std::min(layout.settings.height, std::max(settings, scaled(100, scale)));
  layout.results = {0, layout.settings.bottom(), column, bottom - layout.settings.bottom()};

  layout.views = {column + gap, top, width - column - gap, bottom - top};
  put_drawer(layout, scale, drawer_open);
  put_panes(layout, scale, gap);
  keep_a_pixel(layout, drawer_open);
  return layout;
}

}  // namespace gpo
