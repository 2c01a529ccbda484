// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/palette.h"

#include <string_view>

struct ImFont;

namespace gpo {

class WindowContext;
class WindowImage;

enum class Font { regular, bold, small, heading };

/// Returns the font in the current Dear ImGui context; push it, or draw with it.
ImFont* font(Font font);

std::string_view regular_font();  ///< OpenType, embedded in the program
std::string_view bold_font();

/// Dear ImGui in the current OpenGL context. A screen unit is a pixel of the framebuffer; on HiDPI
/// screens fonts and paddings are larger.
class Gui {
 public:
  static constexpr double kFixedFrame_s = 1.0 / 60;

  /// Without input, for images: the same frames give the same bytes.
  explicit Gui(float content_scale = 1);
  /// For a window; `WindowInput` passes mouse and keys to it.
  explicit Gui(WindowContext& window);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  /// `width` and `height` of the drawn area [px].
  void begin_frame(int width, int height, double delta_seconds = kFixedFrame_s);
  void end_frame();  ///< Renders over the content of the bound framebuffer.
  /// The same, but draws only the parts that changed since the last frame.
  void end_frame(WindowImage& image, std::uint32_t background_rgb);
  /// Factor for sizes in pixels at 96 dpi.
  float scale() const { return scale_; }
  /// Scale of the screen, which changes when the window moves to another one.
  void set_screen_scale(float content_scale) { screen_scale_ = content_scale; }
  /// Magnifies everything beyond the screen's scale. Call it between two frames.
  void set_zoom(double zoom);

  Theme theme() const { return theme_; }
  void set_theme(Theme theme);

 private:
  void create();

  float screen_scale_;
  float scale_ = screen_scale_;
  Theme theme_ = Theme::dark;
  bool has_window_;
};

/// Returns the theme of the current Dear ImGui context (`Gui::set_theme`); dark if there is none.
/// Like fonts and style it is a property of the context, so that draw functions need no parameter.
Theme current_theme();

std::uint32_t color_of(Role role);  ///< In the current theme.
/// Packed as in Dear ImGui. `alpha` in 0..1.
std::uint32_t imgui_color(Role role, double alpha = 1);

}  // namespace gpo
