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

}  // namespace

WindowLayout window_layout(float width, float height, float scale) {
  const auto scaled = [&](float length) { return std::round(length * scale); };
  // A window too small for its scale shrinks the fixed parts rather than the pictures to nothing.
  const float column = std::min(scaled(kColumnWidth), std::round(width * 0.38f));
  const float menu = scaled(kMenuHeight);
  const float status = scaled(kStatusHeight);
  const float timeline = std::min(scaled(kTimelineHeight), std::round(height * 0.2f));
  const float gap = std::max(1.0f, scaled(1));

  WindowLayout layout;
  layout.menu = {0, 0, width, menu};
  layout.status = {0, height - status, width, status};
  layout.timeline = {0, layout.status.y - timeline, width, timeline};
  const float top = menu;
  const float bottom = layout.timeline.y - gap;

  const float settings =
      std::min(scaled(kSettingsHeight), std::round((bottom - top) - scaled(kLeastResultsHeight)));
  layout.settings = {0, top, column, std::max(settings, std::round((bottom - top) / 2))};
  layout.settings.height = std::min(layout.settings.height, std::max(settings, scaled(100)));
  layout.results = {0, layout.settings.bottom(), column, bottom - layout.settings.bottom()};

  const Rectangle views{column + gap, top, width - column - gap, bottom - top};
  layout.picture = layout.scene = views;
  if (views.width >= 1.2f * views.height) {
    layout.picture.width = std::round((views.width - gap) * kPictureShare);
    layout.scene.x = layout.picture.right() + gap;
    layout.scene.width = views.right() - layout.scene.x;
  } else {
    layout.picture.height = std::round((views.height - gap) / 2);
    layout.scene.y = layout.picture.bottom() + gap;
    layout.scene.height = views.bottom() - layout.scene.y;
  }
  return layout;
}

}  // namespace gpo
