// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/context/opengl.h"
#include "ui/look/look.h"

#include <span>
#include <string_view>
#include <vector>

#include <imgui.h>

namespace gpo {

/// Marks the content of the texture that is added to the list next. Dear ImGui's lists name only
/// the texture and do not change when another image is uploaded into it.
void mark_content(ImDrawList& list, std::size_t revision);

/// Caches the window's pixels: redraws only the regions where Dear ImGui's lists differ from those
/// of the last frame. Needs its context to be current. A screen unit is a pixel.
class WindowImage {
 public:
  /// Draws into the bound framebuffer, over all of it. `data` is unchanged afterwards.
  void show(ImDrawData& data, std::uint32_t background);

  /// Returns the regions that the last call redrew [px], y down.
  const std::vector<cv::Rect>& redrawn() const { return redrawn_; }

 private:
  struct DrawnList {
    std::vector<ImDrawCmd> commands;
    std::vector<ImDrawVert> vertices;
    std::vector<ImDrawIdx> indices;
    cv::Rect bounds;  ///< contains all that it draws
  };

  void remember(const ImDrawData& data);
  void redraw(ImDrawData& data, const cv::Rect& part, std::uint32_t background) const;

  std::unique_ptr<Framebuffer> framebuffer_;
  cv::Size size_;
  std::vector<DrawnList> lists_;
  std::vector<cv::Rect> redrawn_;
};

enum class Font { regular, bold, small, heading };

ImFont* font(Font font);

std::string_view font_file(bool bold);  ///< OpenType, embedded in the program

/// A context of Dear ImGui in the current OpenGL context, with its own input. It is current from
/// its construction to its destruction, then the one before again. Fonts and paddings are larger on
/// HiDPI screens.
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

  /// Makes its context the current one.
  void make_current() const { ImGui::SetCurrentContext(context_); }
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
  /// Provides glyphs for texts in UTF-8 that the program's fonts lack: from an installed font, else
  /// spelled as "\u4F60". Call it between two frames. Returns whether the fonts have changed: then
  /// the next frame must be drawn as a whole.
  bool provide_glyphs(std::span<const std::string_view> texts);

  Theme theme() const { return theme_; }
  void set_theme(Theme theme);

 private:
  void create();
  void renew_fonts();

  ImGuiContext* before_ = nullptr;
  ImGuiContext* context_ = nullptr;
  float screen_scale_;
  float scale_ = screen_scale_;
  Theme theme_ = Theme::dark;
  bool has_window_;
  std::vector<ImWchar> provided_;  ///< code points beyond the program's fonts, ascending
};

/// A font with some of the requested code points.
struct InstalledFont {
  std::string bytes;                  ///< content of its file
  int index = 0;                      ///< position in a collection of fonts
  std::vector<ImWchar> covered = {};  ///< the requested code points that it has, ascending
  std::vector<ImWchar> ranges = {};   ///< the same for Dear ImGui, one each, and a 0 at the end
};

/// Returns fonts that have as many of the code points (ascending) as possible, each in one of them:
/// the program's `own` one, then those of this machine.
std::vector<InstalledFont> fonts_with(std::vector<ImWchar> code_points, std::string_view own = {});

/// Reserves glyphs of a font for code points that no font has. Call it before the atlas is built.
void reserve_spelled(ImFontAtlas& atlas,
                     ImFont& font,
                     float size_px,
                     std::span<const ImWchar> code_points);
/// Draws all reserved glyphs as "\u4F60", in their own font. Call it after the atlas is built.
void draw_spelled(ImFontAtlas& atlas);

/// Returns the theme of the current Dear ImGui context; dark if there is none.
Theme current_theme();

std::uint32_t color_of(Role role);  ///< In the current theme.
/// Packed as in Dear ImGui. `alpha` in 0..1.
std::uint32_t imgui_color(Role role, double alpha = 1);

}  // namespace gpo
