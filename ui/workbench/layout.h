// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace gpo {

/// In screen pixels, from the top left.
struct Rectangle {
  float x = 0, y = 0, width = 0, height = 0;

  float right() const { return x + width; }
  float bottom() const { return y + height; }
  bool operator==(const Rectangle&) const = default;
};

/// Where the parts of the window are; they do not overlap and fill it but for the gaps.
struct WindowLayout {
  Rectangle menu;      ///< the whole width
  Rectangle settings;  ///< left column, above
  Rectangle results;   ///< left column, below
  Rectangle picture;
  Rectangle scene;
  Rectangle timeline;  ///< the whole width
  Rectangle status;    ///< the whole width
};

/// Divides a window of width x height pixels whose text is `scale` times as large as usual. Picture
/// and scene stand side by side where the space is wide, else one above the other.
WindowLayout window_layout(float width, float height, float scale);

}  // namespace gpo
