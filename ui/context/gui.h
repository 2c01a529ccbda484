// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"

#include <cstdint>

struct ImFont;

namespace gpo {

class WindowContext;
class WindowImage;

enum class Font { regular, bold, small, heading };

/// The font in the current Dear ImGui context; push it, or draw with it.
ImFont* font(Font font);

/// Dear ImGui in the OpenGL context that is current: style, fonts, frames. One screen unit is one
/// pixel of the framebuffer; what is HiDPI is drawn with larger fonts and paddings.
class Gui {
 public:
  static constexpr double kFixedFrame_s = 1.0 / 60;

  /// Without input, for pictures: the same frames give the same bytes.
  explicit Gui(float content_scale = 1);
  /// For that window; `WindowInput` feeds it with mouse and keys.
  explicit Gui(WindowContext& window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// Width and height of what is drawn [px]. `framebuffer_scale`: pixels a screen unit; 1 on X11.
  void begin_frame(int width,
                   int height,
                   float framebuffer_scale = 1,
                   double delta_seconds = kFixedFrame_s);
  /// Renders into the framebuffer that is bound, over what is there.
  void end_frame();
  /// The same, but draws only what has changed since the picture's last frame.
  void end_frame(WindowImage& image, std::uint32_t background_rgb);
  /// Sizes in pixels that were made for 96 dpi are to be multiplied by this.
  float scale() const { return scale_; }
  /// Everything so many times as large as the screen's own scale has it, which a window that moves
  /// to another screen changes. Between two frames.
  void set_screen_scale(float content_scale) { screen_scale_ = content_scale; }
  void set_zoom(double zoom);

  Theme theme() const { return theme_; }
  /// Of everything that is drawn from now on.
  void set_theme(Theme theme);

 private:
  void create();

  float screen_scale_;
  float scale_ = screen_scale_;
  Theme theme_ = Theme::dark;
  bool has_window_;
};

}  // namespace gpo
