// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"

#include "ui/context/imgui_versions.h"

#include <algorithm>
#include <cstring>

#include <GL/glew.h>
#include <backends/imgui_impl_opengl3.h>

extern "C" {
extern const char gpo_font_regular[], gpo_font_regular_end[];
extern const char gpo_font_bold[], gpo_font_bold_end[];
}

namespace gpo {
namespace {

void apply_colors(ImVec4* colors, Theme theme) {
  using enum Role;
  struct Row {
    ImGuiCol item;
    Role role;
    float alpha = 1;
  };
  // clang-format off
  static constexpr Row kRows[] = {
      {ImGuiCol_Text, text}, {ImGuiCol_TextDisabled, text_dim}, {ImGuiCol_TextSelectedBg, accent, 0.35F},
      {ImGuiCol_WindowBg, panel}, {ImGuiCol_ChildBg, panel}, {ImGuiCol_MenuBarBg, background},
      {ImGuiCol_PopupBg, raised, 0.98F}, {ImGuiCol_ModalWindowDimBg, background, 0.6F},
      {ImGuiCol_Border, border}, {ImGuiCol_BorderShadow, border, 0}, {ImGuiCol_FrameBg, raised},
      {ImGuiCol_FrameBgHovered, hovered}, {ImGuiCol_FrameBgActive, active},
      {ImGuiCol_Button, raised}, {ImGuiCol_ButtonHovered, hovered}, {ImGuiCol_ButtonActive, active},
      {ImGuiCol_Header, raised}, {ImGuiCol_HeaderHovered, hovered}, {ImGuiCol_HeaderActive, active},
      {ImGuiCol_CheckMark, accent}, {ImGuiCol_SliderGrab, accent}, {ImGuiCol_SliderGrabActive, text},
      {ImGuiCol_TitleBg, background}, {ImGuiCol_TitleBgCollapsed, background}, {ImGuiCol_TitleBgActive, raised},
      {ImGuiCol_Tab, panel}, {ImGuiCol_TabUnfocused, panel}, {ImGuiCol_TabHovered, hovered},
      {ImGuiCol_TabActive, active}, {ImGuiCol_TabUnfocusedActive, active}, {ImGuiCol_Separator, border},
      {ImGuiCol_SeparatorHovered, accent, 0.6F}, {ImGuiCol_SeparatorActive, accent},
      {ImGuiCol_ResizeGrip, border}, {ImGuiCol_ResizeGripHovered, accent, 0.6F}, {ImGuiCol_ResizeGripActive, accent},
      {ImGuiCol_ScrollbarBg, background, 0}, {ImGuiCol_ScrollbarGrab, hovered},
      {ImGuiCol_ScrollbarGrabHovered, active}, {ImGuiCol_ScrollbarGrabActive, active},
      {ImGuiCol_TableHeaderBg, raised}, {ImGuiCol_TableBorderStrong, border}, {ImGuiCol_TableBorderLight, border},
      {ImGuiCol_TableRowBg, panel, 0}, {ImGuiCol_TableRowBgAlt, text, 0.03F}, {ImGuiCol_NavHighlight, accent},
      {ImGuiCol_PlotHistogram, accent}, {ImGuiCol_PlotLines, accent}};
  // clang-format on
  for (const auto& [item, role, alpha] : kRows) {
    colors[item] = ImGui::ColorConvertU32ToFloat4(imgui_color(color_of(role, theme)));
    colors[item].w = alpha;
  }
}

/// Adds a font with digits of equal width, so that changing numbers do not move; Inter's differ.
void add_font(std::string_view font, float size_px) {
  static const ImWchar digits[] = {'0', '9', 0};
  // Latin with ° ² ± × ·, Greek, Cyrillic, – … and quotes, arrows, − √ ≈ ≤ ≥, ○ ● ▶ ◀, ticks and
  // crosses.
  // clang-format off
  static const ImWchar others[] = {0x0020, 0x024F, 0x0370, 0x03FF, 0x0400, 0x052F, 0x2010, 0x2044, 0x2190, 0x2199,
                                   0x2200, 0x2265, 0x25A0, 0x25FF, 0x2713, 0x2717, 0};
  // clang-format on
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  auto* bytes = const_cast<char*>(font.data());  // Dear ImGui only reads them
  for (const ImWchar* ranges : {digits, others}) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;
    config.GlyphRanges = ranges;
    config.MergeMode = ranges == others;
    if (ranges == digits)
      config.GlyphMinAdvanceX = config.GlyphMaxAdvanceX = std::round(0.53F * size_px);
    atlas.AddFontFromMemoryTTF(bytes, static_cast<int>(font.size()), size_px, &config);
  }
}

void apply_style(float scale, Theme theme) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  apply_colors(style.Colors, theme);
  style.WindowPadding = ImVec2(12, 10);
  style.FramePadding = ImVec2(9, 5);
  style.ItemSpacing = ImVec2(8, 7);
  style.ItemInnerSpacing = ImVec2(7, 4);
  style.CellPadding = ImVec2(8, 4);
  style.WindowBorderSize = style.PopupBorderSize = style.ChildBorderSize = 1;
  style.FrameBorderSize = style.TabBorderSize = 0;
  style.WindowRounding = style.ChildRounding = 0;
  style.FrameRounding = style.PopupRounding = style.GrabRounding = style.TabRounding = 4;
  style.ScrollbarRounding = 6;
  style.ScrollbarSize = 12;
  style.GrabMinSize = 11;
  style.WindowTitleAlign = ImVec2(0.0F, 0.5F);
  style.ScaleAllSizes(scale);
}

/// Adds glyphs to the last font.
void add_installed(std::span<const InstalledFont> installed, float size_px) {
  for (const InstalledFont& font : installed) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 1;
    config.FontNo = font.index;
    config.GlyphRanges = font.ranges.data();
    config.MergeMode = true;
    ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<char*>(font.bytes.data()),
                                               static_cast<int>(font.bytes.size()),
                                               size_px,
                                               &config);
  }
}

/// Shows a box instead of a question mark for characters that cannot have a glyph.
void set_fallback(ImFont& font) {
  constexpr ImWchar kBox = 0x25A1;
  if (font.FindGlyphNoFallback(kBox) == nullptr) return;
  font.FallbackChar = kBox;
  font.BuildLookupTable();
}

/// Loads and draws the fonts in the order of `Font`, with further code points (ascending).
void load_fonts(float scale, std::vector<ImWchar> further) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  const std::vector<InstalledFont> installed = fonts_with(further, font_file(false));
  for (const InstalledFont& one : installed)
    std::erase_if(further,
                  [&](ImWchar code) { return std::ranges::binary_search(one.covered, code); });
  for (const auto& [bold, size] :
       {std::pair{false, 16.0F}, {true, 16.0F}, {false, 14.0F}, {true, 20.0F}}) {
    const float size_px = std::round(size * scale);
    add_font(font_file(bold), size_px);
    add_installed(installed, size_px);
    reserve_spelled(atlas, *atlas.Fonts.back(), size_px, further);
  }
  atlas.Build();
  draw_spelled(atlas);
  for (ImFont* font : atlas.Fonts) set_fallback(*font);
}

void draws_nothing(const ImDrawList* /*list*/, const ImDrawCmd* /*command*/) {}

template <class T>
bool same_items(const std::vector<T>& a, const ImVector<T>& b) {
  return static_cast<int>(a.size()) == b.Size &&
         (a.empty() || std::memcmp(a.data(), b.Data, a.size() * sizeof(T)) == 0);
}

bool same_rectangle(const ImVec4& a, const ImVec4& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

bool same_command(const ImDrawCmd& a, const ImDrawCmd& b) {
  return same_rectangle(a.ClipRect, b.ClipRect) && a.TextureId == b.TextureId &&
         a.VtxOffset == b.VtxOffset && a.IdxOffset == b.IdxOffset && a.ElemCount == b.ElemCount &&
         a.UserCallback == b.UserCallback && a.UserCallbackData == b.UserCallbackData;
}

/// Rounds outwards to whole pixels; empty if the corners are not in order.
cv::Rect outer_rect(float x0, float y0, float x1, float y1) {
  const cv::Point low(static_cast<int>(std::floor(x0)), static_cast<int>(std::floor(y0)));
  const cv::Point high(static_cast<int>(std::ceil(x1)), static_cast<int>(std::ceil(y1)));
  return high.x > low.x && high.y > low.y ? cv::Rect(low, high) : cv::Rect();
}

cv::Rect bounds_of(const ImDrawList& list) {
  if (list.VtxBuffer.empty()) return {};
  ImVec2 low = list.VtxBuffer[0].pos, high = low;
  for (const ImDrawVert& vertex : list.VtxBuffer) {
    low = {std::min(low.x, vertex.pos.x), std::min(low.y, vertex.pos.y)};
    high = {std::max(high.x, vertex.pos.x), std::max(high.y, vertex.pos.y)};
  }
  cv::Rect clips;
  for (const ImDrawCmd& command : list.CmdBuffer) {
    const ImVec4& clip = command.ClipRect;
    if (command.ElemCount > 0) clips |= outer_rect(clip.x, clip.y, clip.z, clip.w);
  }
  return clips & outer_rect(low.x, low.y, high.x, high.y);
}

/// Merges overlapping rectangles, so that no pixel is drawn twice.
void add(std::vector<cv::Rect>& rects, cv::Rect rect) {
  if (rect.empty()) return;
  for (auto other = rects.begin(); other != rects.end();) {
    if ((*other & rect).empty()) {
      ++other;
    } else {
      rect |= *other;
      rects.erase(other);
      other = rects.begin();
    }
  }
  rects.push_back(rect);
}

void clear(const cv::Rect& part, int height, std::uint32_t rgb) {
  glEnable(GL_SCISSOR_TEST);
  glScissor(part.x, height - part.br().y, part.width, part.height);
  const ImVec4 color = ImGui::ColorConvertU32ToFloat4(imgui_color(rgb));
  glClearColor(color.x, color.y, color.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

}  // namespace

std::string_view font_file(bool bold) {
  return bold ? std::string_view(gpo_font_bold, gpo_font_bold_end)
              : std::string_view(gpo_font_regular, gpo_font_regular_end);
}

ImFont* font(Font font) { return ImGui::GetIO().Fonts->Fonts[static_cast<int>(font)]; }

void Gui::create() {
  IMGUI_CHECKVERSION();
  before_ = ImGui::GetCurrentContext();
  context_ = ImGui::CreateContext();
  make_current();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigDragClickToInputText = true;  // else digits after a click would choose a method
  io.UserData = this;
  apply_style(scale_, theme_);
  load_fonts(scale_, {});
}

Gui::Gui(float content_scale) : screen_scale_(content_scale), has_window_(false) {
  create();
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::Gui(WindowContext& window) : screen_scale_(window.content_scale()), has_window_(true) {
  create();
  take_events_as_they_come();
  ImGui_ImplGlfw_InitForOpenGL(window.glfw(), false);
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
  make_current();
  ImGui_ImplOpenGL3_Shutdown();
  if (has_window_) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext(context_);
  ImGui::SetCurrentContext(before_);
}

void Gui::set_theme(Theme theme) {
  theme_ = theme;
  apply_style(scale_, theme_);
}

void Gui::set_zoom(double zoom) {
  const float scale = screen_scale_ * static_cast<float>(zoom);
  if (scale == scale_) return;
  scale_ = scale;
  apply_style(scale_, theme_);
  renew_fonts();
}

void Gui::renew_fonts() {
  ImGui::GetIO().Fonts->Clear();
  load_fonts(scale_, provided_);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

bool Gui::provide_glyphs(std::span<const std::string_view> texts) {
  constexpr std::size_t kMost = 2000;  // more would need a texture that graphics cards refuse
  const std::size_t before = provided_.size();
  for (const std::string_view text : texts) {
    for (auto at = std::ranges::find_if(text, [](char c) { return (c & 0x80) != 0; });
         at < text.end();) {
      unsigned int code = 0;
      at += std::max(1, ImTextCharFromUtf8(&code, &*at, text.data() + text.size()));
      if (code < 0x80 || code >= IM_UNICODE_CODEPOINT_INVALID) continue;
      const auto letter = static_cast<ImWchar>(code);
      const auto place = std::ranges::lower_bound(provided_, letter);
      const bool known = (place != provided_.end() && *place == letter) ||
                         font(Font::regular)->FindGlyphNoFallback(letter) != nullptr;
      if (!known && provided_.size() < kMost) provided_.insert(place, letter);
    }
  }
  if (provided_.size() == before) return false;
  renew_fonts();
  return true;
}

void Gui::begin_frame(int width, int height, double delta_seconds) {
  ImGui_ImplOpenGL3_NewFrame();
  if (has_window_) ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
  io.DisplayFramebufferScale = ImVec2(1, 1);
  // Dear ImGui asserts that time passes.
  io.DeltaTime = std::max(static_cast<float>(delta_seconds), 1e-5F);
  ImGui::NewFrame();
}

void Gui::end_frame() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Gui::end_frame(WindowImage& image, std::uint32_t background_rgb) {
  ImGui::Render();
  image.show(*ImGui::GetDrawData(), background_rgb);
}

Theme current_theme() {
  if (ImGui::GetCurrentContext() == nullptr) return Theme::dark;
  const auto* gui = static_cast<const Gui*>(ImGui::GetIO().UserData);
  return gui != nullptr ? gui->theme() : Theme::dark;
}

std::uint32_t color_of(Role role) { return color_of(role, current_theme()); }

std::uint32_t imgui_color(Role role, double alpha) { return imgui_color(color_of(role), alpha); }

void mark_content(ImDrawList& list, std::size_t revision) {
  // Never read as an address. NOLINTNEXTLINE(performance-no-int-to-ptr)
  list.AddCallback(draws_nothing, reinterpret_cast<void*>(revision));
}

/// Collects the regions where the lists differ from those of the last frame.
void WindowImage::remember(const ImDrawData& data) {
  const auto count = static_cast<std::size_t>(data.CmdListsCount);
  for (std::size_t i = count; i < lists_.size(); ++i) add(redrawn_, lists_[i].bounds);
  lists_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const ImDrawList& list = *data.CmdLists[i];
    DrawnList& last = lists_[i];
    if (std::ranges::equal(last.commands, list.CmdBuffer, same_command) &&
        same_items(last.vertices, list.VtxBuffer) && same_items(last.indices, list.IdxBuffer))
      continue;
    add(redrawn_, last.bounds);
    last = {{list.CmdBuffer.begin(), list.CmdBuffer.end()},
            {list.VtxBuffer.begin(), list.VtxBuffer.end()},
            {list.IdxBuffer.begin(), list.IdxBuffer.end()},
            bounds_of(list)};
    add(redrawn_, last.bounds);
  }
}

/// Redraws a region from all lists in it: they cover each other.
void WindowImage::redraw(ImDrawData& data, const cv::Rect& part, std::uint32_t background) const {
  clear(part, size_.height, background);
  std::vector<ImDrawList*> lists;
  for (std::size_t i = 0; i < lists_.size(); ++i) {
    if ((lists_[i].bounds & part).empty()) continue;
    lists.push_back(data.CmdLists[i]);
    for (ImDrawCmd& command : data.CmdLists[i]->CmdBuffer) {
      ImVec4& clip = command.ClipRect;
      clip = {std::max(clip.x, static_cast<float>(part.x)),
              std::max(clip.y, static_cast<float>(part.y)),
              std::min(clip.z, static_cast<float>(part.br().x)),
              std::min(clip.w, static_cast<float>(part.br().y))};
    }
  }
  ImDrawData of_part = data;
  set_draw_lists(of_part, lists);
  ImGui_ImplOpenGL3_RenderDrawData(&of_part);
  for (std::size_t i = 0; i < lists_.size(); ++i)
    std::ranges::copy(lists_[i].commands, data.CmdLists[i]->CmdBuffer.begin());
}

void WindowImage::show(ImDrawData& data, std::uint32_t background) {
  GLint target = 0;
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &target);
  redrawn_.clear();
  remember(data);
  const cv::Size size(static_cast<int>(data.DisplaySize.x), static_cast<int>(data.DisplaySize.y));
  const cv::Rect whole({0, 0}, size);
  if (!framebuffer_ || size != size_) {
    framebuffer_ = std::make_unique<Framebuffer>(size.width, size.height);
    size_ = size;
    redrawn_ = {whole};
  }
  framebuffer_->bind();
  for (cv::Rect& part : redrawn_) {
    part &= whole;
    if (!part.empty()) redraw(data, part, background);
  }
  framebuffer_->copy_to(static_cast<unsigned>(target));
}

}  // namespace gpo
