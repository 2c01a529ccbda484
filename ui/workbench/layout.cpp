// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/workbench/layout.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace gpo {
namespace {

// Lengths at scale 1. An image fills its share of the views' width, a scene is mostly empty.
constexpr float kImageShare = 0.57F, kDrawerShare = 0.36F;
constexpr float kMenuHeight = 26, kStatusHeight = 26, kTabsHeight = 26, kTimelineHeight = 90;
constexpr float kBannerHeight = 34;
constexpr float kColumnWidth = 292, kSettingsHeight = 266, kLeastResultsHeight = 170;
constexpr float kVerdictHeight = 92;
constexpr float kLeastDrawerHeight = 170, kMostDrawerHeight = 420;
// Limits while dragging.
constexpr float kLeastColumn = 200, kMostColumn = 640;
constexpr float kLeastSettings = 80;
constexpr double kLeastShare = 0.12;

float scaled(float length, float scale) { return std::round(length * scale); }

void put_drawer(WindowLayout& layout, float scale, const Division& division, bool open) {
  Rectangle& views = layout.views;
  const float tabs = scaled(kTabsHeight, scale);
  float height = std::min(std::clamp(views.height * kDrawerShare,
                                     scaled(kLeastDrawerHeight, scale),
                                     scaled(kMostDrawerHeight, scale)),
                          views.height * 0.5F);
  if (division.drawer_share > 0) height = views.height * static_cast<float>(division.drawer_share);
  height = open ? std::round(height) : 0;
  views.height -= tabs + height;
  layout.drawer_tabs = {views.x, views.bottom(), views.width, tabs};
  layout.drawer = {views.x, layout.drawer_tabs.bottom(), views.width, height};
}

/// Splits the drawer's place in two halves.
void put_beside(WindowLayout& layout, float gap) {
  layout.beside = layout.drawer;
  layout.drawer.width = std::round((layout.drawer.width - gap) / 2);
  layout.beside.x = layout.drawer.right() + gap;
  layout.beside.width -= layout.drawer.width + gap;
}

bool side_by_side(const Rectangle& views) { return views.width >= 1.2f * views.height; }

void put_panes(WindowLayout& layout, float scale, float gap, const Division& division) {
  const Rectangle& views = layout.views;
  const float tabs = scaled(kTabsHeight, scale);
  Rectangle side = layout.image = views;
  const auto given = static_cast<float>(division.image_share);
  if (side_by_side(views)) {
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

/// Keeps a pixel of each part even in a window smaller than its bars.
void keep_a_pixel(WindowLayout& layout, bool drawer_open) {
  for (Rectangle* part : {&layout.verdict,
                          &layout.settings,
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

/// The verdict is as high as its content, and so are the settings unless the results need the room.
void put_column(WindowLayout& layout, Rectangle column, float scale, const LayoutInput& input) {
  const double wanted_px = input.division.settings_px;
  const float verdict =
      input.verdict_height > 0 ? input.verdict_height : scaled(kVerdictHeight, scale);
  layout.verdict = {
      column.x, column.y, column.width, std::round(std::min(verdict, column.height * 0.4F))};
  column.y += layout.verdict.height;
  column.height -= layout.verdict.height;
  const float content =
      input.settings_height > 0 ? input.settings_height : scaled(kSettingsHeight, scale);
  const float most = std::round(column.height - scaled(kLeastResultsHeight, scale));
  float settings = std::round(std::min(content, most));
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

void maximize(WindowLayout& layout, const Rectangle& all, float scale, WindowPart part) {
  const float tabs_height = scaled(kTabsHeight, scale);
  const Rectangle tabs{all.x, all.y, all.width, tabs_height};
  const Rectangle below{all.x, tabs.bottom(), all.width, all.height - tabs_height};
  layout.verdict = layout.settings = layout.results = layout.beside = layout.banner = {};
  layout.image = layout.side_tabs = layout.side = {};
  layout.drawer_tabs = layout.drawer = {};
  layout.views = all;
  if (part == WindowPart::image) layout.image = all;
  if (part == WindowPart::side) {
    layout.side_tabs = tabs;
    layout.side = below;
  } else if (part == WindowPart::drawer) {
    layout.views = {};
    layout.drawer_tabs = tabs;
    layout.drawer = below;
  }
}

// Grouped by kind, as `of_kind` expects.
// clang-format off
constexpr auto kPanes = [] {
  using enum PaneKind;
  constexpr PaneNeeds kCompared = {.compared = true};
  return std::to_array<Pane>({
    {image, "image", "Image", "The frame with its overlays", {}, false, "picture"},
    {side, "scene", "Scene", "Cameras, plane, points and cube in 3-D", {}, true},
    {side, "normals", "Normals", "The hemisphere of plane normals: cost, candidates, results",
     {.compared = true, .study = true}},
    {side, "solver", "Solver", "Cost, gradient and step over the iterations", kCompared},
    {side, "candidates", "Candidates",
     "All decompositions of the homography and why they were rejected",
     {.study = true}},
    {columns, "compare", "Compare", "The compared methods side by side on the same frame",
     kCompared},
    {drawer, "curves", "Curves", "Errors over the window length",
     {.compared = true, .lengths = true}},
    {drawer, "table", "Table", "The compared results in numbers and their differences", kCompared},
    {drawer, "residuals", "Residuals", "Histogram and RMS for each frame"},
    {drawer, "timing", "Timing", "Run time of each stage", kCompared},
    {drawer, "track", "Track", "The whole life of the selected track"},
    {drawer, "tracks", "Tracks", "All tracks of the window, to sort and select"},
    {drawer, "camera", "Camera", "Camera, sensors, clocks, gaps, and the report of a calibration"},
    {drawer, "log", "Log", "All messages"},
    {window, "window", "Window", "The whole workbench"}});
}();
// clang-format on

constexpr std::span<const Pane> of_kind(PaneKind kind) {
  const auto first = std::ranges::find(kPanes, kind, &Pane::kind);
  return {first, std::ranges::find_if(first, kPanes.end(), [=](const Pane& pane) {
            return pane.kind != kind;
          })};
}

}  // namespace

WindowLayout window_layout(const LayoutInput& input) {
  const auto& [width, height, scale, division] =
      std::tie(input.width, input.height, input.scale, input.division);
  // In a window too small for its scale the fixed parts shrink, so that the views keep some space.
  const bool dragged_column = division.column_px > 0;
  const float wanted = dragged_column ? static_cast<float>(division.column_px) : kColumnWidth;
  const float most = std::round(width * (dragged_column ? 0.6f : 0.38f));
  const float column = division.column ? std::min(scaled(wanted, scale), most) : 0;
  const float menu = scaled(kMenuHeight, scale);
  const float status = scaled(kStatusHeight, scale);
  const float time_height = kTimelineHeight + (input.scan ? kScanHeight : 0);
  const float timeline =
      division.timeline ? std::min(scaled(time_height, scale), std::round(height * 0.2f)) : 0;
  const float gap = std::max(1.0f, scaled(1, scale));

  WindowLayout layout;
  layout.menu = {0, 0, width, menu};
  layout.status = {0, height - status, width, status};
  layout.timeline = {0, layout.status.y - timeline, width, timeline};
  const float bottom = layout.timeline.y - gap;
  put_column(layout, {0, menu, column, bottom - menu}, scale, input);
  const float left = division.column ? column + gap : 0;
  const float banner = input.failed ? scaled(kBannerHeight, scale) : 0;
  if (input.failed) layout.banner = {left, menu, width - left, banner};
  layout.views = {left, menu + banner, width - left, bottom - menu - banner};
  put_drawer(layout, scale, division, input.drawer_open);
  put_panes(layout, scale, gap, division);
  keep_a_pixel(layout, input.drawer_open);
  if (input.drawer_open && input.beside_open) put_beside(layout, gap);
  if (!division.column) layout.verdict = layout.settings = layout.results = {};
  if (!division.timeline) layout.timeline = {};
  const bool possible = division.maximized != WindowPart::drawer || input.drawer_open;
  if (division.maximized != WindowPart::none && possible) {
    const Rectangle all{0, menu, std::max(width, 1.0F), std::max(bottom - menu, 1.0F)};
    maximize(layout, all, scale, division.maximized);
    if (division.maximized == WindowPart::drawer && input.beside_open) put_beside(layout, gap);
  }
  return layout;
}

Rectangle place_of(Splitter splitter, const WindowLayout& layout, float scale) {
  const float gap = std::max(1.0f, scaled(1, scale));
  const auto& [settings, views, image, drawer, tabs] =
      std::tie(layout.settings, layout.views, layout.image, layout.drawer, layout.drawer_tabs);
  if (splitter == Splitter::column && !settings.empty() && !views.empty())
    return {views.x - gap,
            layout.verdict.y,
            gap,
            layout.verdict.height + settings.height + layout.results.height};
  if (splitter == Splitter::settings && !settings.empty())
    return {settings.x, settings.bottom() - gap, settings.width, gap};
  if (splitter == Splitter::image && !image.empty() && !layout.side.empty())
    return side_by_side(views) ? Rectangle{image.right(), image.y, gap, image.height}
                               : Rectangle{image.x, image.bottom(), image.width, gap};
  if (splitter == Splitter::drawer && !views.empty() && !drawer.empty())
    return {tabs.x, tabs.y - gap, tabs.width, gap};
  return {};
}

Division dragged(
    Division division, Splitter splitter, const WindowLayout& layout, DragPoint to, float scale) {
  const Rectangle& views = layout.views;
  const auto share = [](float part, float whole) {
    return std::clamp(static_cast<double>(part / whole), kLeastShare, 1 - kLeastShare);
  };
  if (splitter == Splitter::column)
    division.column_px = std::clamp(to.x / scale, kLeastColumn, kMostColumn);
  if (splitter == Splitter::settings)
    division.settings_px = std::max((to.y - layout.settings.y) / scale, kLeastSettings);
  if (splitter == Splitter::image)
    division.image_share = side_by_side(views) ? share(to.x - views.x, views.width)
                                               : share(to.y - views.y, views.height);
  if (splitter == Splitter::drawer) {
    constexpr double kMostDrawer = 0.8;
    const float bottom = layout.drawer.bottom(), tabs = layout.drawer_tabs.height;
    division.drawer_share = std::min(share(bottom - to.y - tabs, bottom - views.y), kMostDrawer);
  }
  return division;
}

Division automatic(Division division, Splitter splitter) {
  using D = Division;
  double D::*const lengths[] = {&D::column_px, &D::settings_px, &D::image_share, &D::drawer_share};
  division.*lengths[static_cast<int>(splitter)] = 0;
  return division;
}

std::span<const Pane> panes() { return kPanes; }
std::span<const Pane> side_panes() { return of_kind(PaneKind::side); }
std::span<const Pane> drawers() { return of_kind(PaneKind::drawer); }

const Pane* find_pane(const std::string& name, std::span<const Pane> among) {
  const auto found = std::ranges::find_if(among, [&](const Pane& pane) {
    return name == pane.key || (!name.empty() && name == pane.alias);
  });
  return found == among.end() ? nullptr : &*found;
}

std::vector<std::string> pane_names() {
  std::vector<std::string> names;
  for (const Pane& pane : panes()) {
    names.emplace_back(pane.key);
    if (*pane.alias != 0) names.emplace_back(pane.alias);
  }
  return names;
}

PaneNeeds needs_of(const Panes& panes) {
  const PaneNeeds side = panes.side->needs;
  const auto of = [](const Pane* pane) { return pane == nullptr ? PaneNeeds{} : pane->needs; };
  const PaneNeeds drawer = of(panes.drawer), beside = of(panes.beside);
  // In compare mode the columns hide the side pane and its study.
  return {.compared = panes.compare || side.compared || drawer.compared || beside.compared,
          .lengths = side.lengths || drawer.lengths || beside.lengths,
          .study = (side.study && !panes.compare) || drawer.study || beside.study};
}

}  // namespace gpo
