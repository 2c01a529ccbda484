// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/layout.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace gpo {

namespace {

// At scale 1.
constexpr float kImageShare =
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
// What a drag leaves of each part.
constexpr float kLeastColumn = 200, kMostColumn = 640;
constexpr float kLeastSettings = 80;
constexpr double kLeastShare = 0.12;

float scaled(float length, float scale) { return std::round(length * scale); }

/// Takes the drawer off the lower end of the views.
void put_drawer(WindowLayout& layout, float scale, const Division& division, bool open) {
  Rectangle& views = layout.views;
  const float tabs = scaled(kTabsHeight, scale);
  const float by_itself = std::round(std::min(std::clamp(views.height * kDrawerShare,
                                                         scaled(kLeastDrawerHeight, scale),
                                                         scaled(kMostDrawerHeight, scale)),
                                              views.height * 0.5F));
  const float wanted = division.drawer_share > 0
                           ? std::round(views.height * static_cast<float>(division.drawer_share))
                           : by_itself;
  const float height = open ? wanted : 0;
  views.height -= tabs + height;
  layout.drawer_tabs = {views.x, views.bottom(), views.width, tabs};
  layout.drawer = {views.x, layout.drawer_tabs.bottom(), views.width, height};
}

/// Picture and side pane, else one above the other.
bool places_side_by_side(const Rectangle& views) { return views.width >= 1.2f * views.height; }

/// Picture and side pane within the views.
void put_panes(WindowLayout& layout, float scale, float gap, const Division& division) {
  const Rectangle& views = layout.views;
  const float tabs = scaled(kTabsHeight, scale);
  Rectangle side = layout.image = views;
  const auto given = static_cast<float>(division.image_share);
  if (places_side_by_side(views)) {
    const float share = given > 0 ? given : kImageShare;
    layout.image.width = std::round((views.width - gap) * share);
    side.x = layout.image.right() + gap;
    side.width = views.right() - side.x;
  } else {
    const float share = given > 0 ? given : 0.5F;
    layout.image.height = std::round((views.height - gap) * share);
    side.y = layout.image.bottom() + gap;
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
                          &layout.image,
                          &layout.side_tabs,
                          &layout.side,
                          &layout.drawer_tabs,
                          &layout.drawer,
                          &layout.timeline}) {
    part->width = std::max(part->width, 1.0F);
    if (part != &layout.drawer || drawer_open) part->height = std::max(part->height, 1.0F);
  }
}

/// The upper and the lower part of the left column.
void put_column(WindowLayout& layout, const Rectangle& column, float scale, double wanted_px) {
  const float most = std::round(column.height - scaled(kLeastResultsHeight, scale));
  float settings = std::min(scaled(kSettingsHeight, scale), most);
  const float half = std::max(settings, std::round(column.height / 2));
  settings = std::min(half, std::max(settings, scaled(100, scale)));
  if (wanted_px > 0) {
    const float least = scaled(kLeastSettings, scale);
    settings = std::clamp(scaled(static_cast<float>(wanted_px), scale),
                          least,
                          std::max(least, column.height - least));
  }
  layout.settings = {column.x, column.y, column.width, settings};
  layout.results = {column.x, layout.settings.bottom(), column.width, column.height - settings};
}

/// One part has all that lies between the bars.
void maximize(WindowLayout& layout, const Rectangle& all, float scale, WindowPart part) {
  const float tabs_height = scaled(kTabsHeight, scale);
  const Rectangle tabs{all.x, all.y, all.width, tabs_height};
  const Rectangle below{all.x, tabs.bottom(), all.width, all.height - tabs_height};
  layout.settings = layout.results = layout.image = layout.side_tabs = layout.side = {};
  layout.drawer_tabs = layout.drawer = {};
  layout.views = all;
  if (part == WindowPart::image) layout.image = all;
  if (part == WindowPart::side) std::tie(layout.side_tabs, layout.side) = std::tie(tabs, below);
  if (part != WindowPart::drawer) return;
  layout.views = {};
  std::tie(layout.drawer_tabs, layout.drawer) = std::tie(tabs, below);
}

}  // namespace

WindowLayout window_layout(
    float width, float height, float scale, const Division& division, bool drawer_open, bool scan) {
  // A window too small for its scale shrinks the fixed parts rather than the pictures to nothing.
  const float wanted =
      division.column_px > 0 ? static_cast<float>(division.column_px) : kColumnWidth;
  const float column = division.column
                           ? std::min(scaled(wanted, scale),
                                      std::round(width * (division.column_px > 0 ? 0.6f : 0.38f)))
                           : 0;
  const float menu = scaled(kMenuHeight, scale);
  const float status = scaled(kStatusHeight, scale);
  const float time_height = kTimelineHeight + (scan ? kScanHeight : 0);
  const float timeline =
      division.timeline ? std::min(scaled(time_height, scale), std::round(height * 0.2f)) : 0;
  const float gap = std::max(1.0f, scaled(1, scale));

  WindowLayout layout;
  layout.menu = {0, 0, width, menu};
  layout.status = {0, height - status, width, status};
  layout.timeline = {0, layout.status.y - timeline, width, timeline};
  const float top = menu;
  const float bottom = layout.timeline.y - gap;
  put_column(layout, {0, top, column, bottom - top}, scale, division.settings_px);
  const float left = division.column ? column + gap : 0;
  layout.views = {left, top, width - left, bottom - top};
  put_drawer(layout, scale, division, drawer_open);
  put_panes(layout, scale, gap, division);
  keep_a_pixel(layout, drawer_open);
  if (!division.column) layout.settings = layout.results = {};
  if (!division.timeline) layout.timeline = {};
  const bool there = division.maximized != WindowPart::drawer || drawer_open;
  if (division.maximized != WindowPart::none && there) {
    const Rectangle all{0, top, std::max(width, 1.0F), std::max(bottom - top, 1.0F)};
    maximize(layout, all, scale, division.maximized);
  }
  return layout;
}

Rectangle place_of(Splitter splitter, const WindowLayout& layout, float scale) {
  const float gap = std::max(1.0f, scaled(1, scale));
  const auto& [menu,
               settings,
               results,
               views,
               image,
               side_tabs,
               side,
               drawer_tabs,
               drawer,
               timeline,
               status] = layout;
  switch (splitter) {
    case Splitter::column:
      if (settings.empty() || views.empty()) return {};
      return {views.x - gap, settings.y, gap, settings.height + results.height};
    case Splitter::settings:
      if (settings.empty()) return {};
      return {settings.x, settings.bottom() - gap, settings.width, gap};
    case Splitter::image:
      if (image.empty() || side.empty()) return {};
      if (places_side_by_side(views)) return {image.right(), image.y, gap, image.height};
      return {image.x, image.bottom(), image.width, gap};
    case Splitter::drawer:
      if (views.empty() || drawer.empty()) return {};
      return {drawer_tabs.x, drawer_tabs.y - gap, drawer_tabs.width, gap};
  }
  return {};
}

Division dragged(const Division& division,
                 Splitter splitter,
                 const WindowLayout& layout,
                 float x,
                 float y,
                 float scale) {
  Division result = division;
  const Rectangle& views = layout.views;
  const auto share = [](float part, float whole) {
    return std::clamp(static_cast<double>(part / whole), kLeastShare, 1 - kLeastShare);
  };
  switch (splitter) {
    case Splitter::column:
      result.column_px = std::clamp(x / scale, kLeastColumn, kMostColumn);
      break;
    case Splitter::settings:
      result.settings_px = std::max((y - layout.settings.y) / scale, kLeastSettings);
      break;
    case Splitter::image:
      result.image_share =
          places_side_by_side(views) ? share(x - views.x, views.width) : share(y - views.y, views.height);
      break;
    case Splitter::drawer: {
      const float tabs = layout.drawer_tabs.height;
      const float whole = layout.drawer.bottom() - views.y;
      constexpr double kMostDrawer = 0.8;
      result.drawer_share = std::min(share(layout.drawer.bottom() - y - tabs, whole), kMostDrawer);
      break;
    }
  }
  return result;
}

Division automatic(Division division, Splitter splitter) {
  double Division::*const lengths[] = {&Division::column_px,
                                       &Division::settings_px,
                                       &Division::image_share,
                                       &Division::drawer_share};
  division.*lengths[static_cast<int>(splitter)] = 0;
  return division;
}

}  // namespace gpo
