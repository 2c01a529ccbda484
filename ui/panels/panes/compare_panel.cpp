// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/method_defaults.h"
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr float kHeight = 24, kGap = 6;  // chip at scale 1 [px]

/// Returns whether the x was clicked. `dim`: it cannot be removed.
bool draw_cross(const std::string& key, const ImVec2& at, float side, bool dim) {
  const bool clicked = hit_area_at(("remove " + key).c_str(), {at.x, at.y, side, side});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered() && !dim;
  const ImU32 color = imgui_color(hovered ? Role::text : Role::text_dim, dim ? 0.35 : 1);
  const ImVec2 middle(at.x + side / 2, at.y + side / 2);
  const float arm = side * 0.17F;
  list.AddLine({middle.x - arm, middle.y - arm}, {middle.x + arm, middle.y + arm}, color, 1.5F);
  list.AddLine({middle.x - arm, middle.y + arm}, {middle.x + arm, middle.y - arm}, color, 1.5F);
  tooltip(dim ? "The last configuration cannot be removed" : "Removes it from the comparison");
  return clicked && !dim;
}

/// `shown`: the compared configuration of that key with what the window makes of it.
void draw_chip(const PanelContext& ui,
               const std::string& key,
               const Configuration& shown,
               float width) {
  const float s = ui.scale;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = std::round(kHeight * s);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float round = 4 * s;
  list.AddRectFilled(at, {at.x + width, at.y + height}, imgui_color(Role::raised), round);
  const ImVec2 bar_end(at.x + std::round(5 * s), at.y + height);
  const ImU32 color = imgui_color(color_of(shown));
  list.AddRectFilled(at, bar_end, color, round, ImDrawFlags_RoundCornersLeft);
  list.AddText(
      {at.x + std::round(12 * s), std::round(at.y + (height - ImGui::GetTextLineHeight()) / 2)},
      imgui_color(Role::text),
      title_of(shown).c_str());
  const bool removable = ui.state.document.compared.size() > 1;
  if (draw_cross(key, {at.x + width - height, at.y}, height, !removable))
    push(ui.commands, RunAction{"compare remove " + key});
}

/// Returns the current settings as a compared configuration, with RANSAC on or off if requested.
Configuration current(const WorkbenchState& state, std::optional<bool> ransac) {
  Settings settings = state.document.settings;
  if (ransac) settings.options.ransac = ransac;
  return name_among_compared(state, settings);
}

void entry(const PanelContext& ui, const Configuration& one, const std::string& title) {
  const std::string key = key_of(one);
  const auto& compared = ui.state.document.compared;
  const bool present = std::ranges::find(compared, one) != compared.end();
  const float side = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 low(at.x, at.y + side * 0.15F), high(at.x + side * 0.35F, at.y + side * 0.85F);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, imgui_color(color_of(one)), side * 0.1F);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + side * 0.7F);
  if (ImGui::MenuItem(fmt::format("{}##{}", title, title + key).c_str(), nullptr, present))
    push(ui.commands, RunAction{(present ? "compare remove " : "compare add ") + key});
}

void add_menu(const PanelContext& ui) {
  if (!ImGui::BeginPopup("add")) return;
  heading("CURRENT SETTINGS");
  const WorkbenchState& state = ui.state;
  entry(ui, current(state, {}), title_of(configuration_of(state.document.settings)));
  const bool ransac = uses_ransac(state.document.settings.options);
  entry(ui, current(state, !ransac), ransac ? "the same without RANSAC" : "the same with RANSAC");
  ImGui::Separator();
  heading("METHODS AND ABLATIONS");
  for (const Configuration& one : parse_configurations("all", state.methods))
    entry(ui, one, title_of(one));
  ImGui::Separator();
  if (ImGui::MenuItem("The four of the paper")) push(ui.commands, RunAction{"compare paper"});
  if (ImGui::MenuItem("All")) push(ui.commands, RunAction{"compare all"});
  ImGui::EndPopup();
}

/// Draws a chip for each compared configuration and a "+". Returns the height of their rows [px].
float compare_chips(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const auto& compared = ui.state.document.compared;
  float x = place.x + kGap * s, y = place.y + kGap * s;
  const auto place_next = [&](float width) {
    if (x > place.x + kGap * s && x + width > place.right() - kGap * s) {
      x = place.x + kGap * s;
      y += (kHeight + kGap) * s;
    }
    ImGui::SetCursorScreenPos({std::round(x), std::round(y)});
    x += width + kGap * s;
  };
  const std::vector<Settings> settings = compared_settings(ui.state, ui.state.document.settings);
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const Configuration shown = name_among_compared(ui.state, settings[i]);
    const float text = ImGui::CalcTextSize(title_of(shown).c_str()).x;
    const float width = std::round(text + (12 + kHeight) * s);
    place_next(width);
    draw_chip(ui, key_of(compared[i]), shown, width);
  }
  const float side = std::round(kHeight * s);
  place_next(side);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
  if (ImGui::Button("+", {side, side})) ImGui::OpenPopup("add");
  ImGui::PopStyleVar();
  tooltip("Adds a method, or the current settings with or without RANSAC");
  add_menu(ui);
  return std::round(y + (kHeight + kGap) * s - place.y);
}

Rectangle to_rectangle(const ScreenRect& rect) {
  const Eigen::Vector2f min = rect.min.cast<float>(), size = rect.size.cast<float>();
  return {min.x(), min.y(), size.x(), size.y()};
}

/// Zooms all columns. A double click shows the whole image, or again the surroundings of the cubes.
void zoom_and_pan(const PanelContext& ui, const ScreenRect& rect, const ImageZoom& zoom) {
  const Camera& camera = shown_recording(ui.state)->camera;
  if (const double by = wheel_zoom(); by != 1)
    push(ui.commands, ZoomCompare{zoom_about(zoom, camera, rect, mouse_px(), by)});
  const Vector2d drag = drag_px();
  if (is_item_double_clicked()) {
    const auto& shown = ui.state.view.compare_zoom;
    const bool whole = shown && shown->factor <= 1;
    push(ui.commands, ZoomCompare{whole ? std::nullopt : std::optional(ImageZoom{})});
  } else if (!drag.isZero()) {
    push(ui.commands, ZoomCompare{pan(zoom, camera, rect, drag)});
  }
}

/// A click on a heading makes its method the current one, which is underlined like an open tab.
void choose_by_heading(const PanelContext& ui, const ScreenRect& place, const Compared& one) {
  hit_area_at(("heading " + key_of(one.configuration)).c_str(), to_rectangle(place));
  if (ImGui::IsItemClicked()) push(ui.commands, ChangeSettings{one.settings});
  const bool chosen = current(ui.state, {}) == one.configuration;
  const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered() && !chosen) list.AddRectFilled(a, b, imgui_color(Role::hovered, 0.5));
  if (chosen)
    list.AddRectFilled({a.x, b.y - std::round(2 * ui.scale)}, b, imgui_color(Role::accent));
  tooltip(chosen ? "The current method, whose settings and results are on the left"
                 : "Click to make it the current method");
}

/// Draws the frame and the window below the chips. Returns the rest of the place.
ScreenRect draw_caption(const PanelContext& ui, const Rectangle& place, ImDrawList& list) {
  const float s = ui.scale;
  const WorkbenchState& state = ui.state;
  const float height = std::round(22 * s);
  const int first = state.document.settings.start;
  const int last = first + state.document.settings.frames - 1;
  const bool inside = state.view.frame >= first && state.view.frame <= last;
  std::string text = fmt::format("frame {}{}", state.view.frame, inside ? "" : ", outside");
  text += fmt::format(" of the window {}\u2013{}", first, last);
  if (state.view.flip) text += " \u00b7 first two swapped";
  write_text(
      list, Font::small, {place.x + 12 * s, place.y + 4 * s}, text, color_of(Role::text_dim));
  const auto width = static_cast<float>(text_width(Font::small, text));
  const bool truth = ui.inspection() && ui.inspection()->truth && state.view.toggles.truth;
  if (inside && place.width > width + 330 * s)
    draw_cube_legend(list, {place.x + 42 * s + width, place.y + 3 * s}, truth);
  return {{place.x, place.y + height}, {place.width, place.height - height}};
}

/// Draws the columns of a frame; they scroll if they would be too low to be useful.
void draw_columns(const PanelContext& ui, int frame, const ScreenRect& visible) {
  constexpr double kLeastHeight = 190, kLeastRow = 290;  // a single row, each of several [px]
  const WorkbenchState& state = ui.state;
  const Recording& recording = *shown_recording(state);
  const std::vector<Compared> columns = compared_results(state);
  const int count = static_cast<int>(columns.size());
  const int rows = (count + 3) / 4;
  const double least = ui.scale * (rows > 1 ? rows * kLeastRow : kLeastHeight);
  const bool scrolls = least > visible.size.y();
  const ImVec2 origin = ImGui::GetCursorScreenPos();  // depends on the scroll position
  ScreenRect rect{{origin.x, origin.y}, visible.size};
  if (scrolls) rect.size = {visible.size.x() - ImGui::GetStyle().ScrollbarSize, least};
  ViewOptions options = view_options(ui, ui.views);
  options.compare_zoom = state.view.compare_zoom;
  options.top_line = false;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const CompareFrame shown{recording, frame, shown_image(ui.views), options};
  draw_compare_view({list, rect}, columns, shown);
  const auto places = compare_places(rect, count, aspect_of(recording), options.top_line);
  const ImageZoom zoom = compare_zoom(columns, shown, places.front().image.size);
  for (std::size_t i = 0; i < places.size(); ++i) {
    choose_by_heading(ui, places[i].heading, columns[i]);
    const std::string name = "picture " + key_of(columns[i].configuration);
    hit_area_at(name.c_str(), to_rectangle(places[i].image));
    zoom_and_pan(ui, places[i].image, zoom);
  }
  if (scrolls) {
    ImGui::SetCursorScreenPos({origin.x, origin.y + static_cast<float>(least) - 1});
    ImGui::Dummy({1, 1});
  }
  if (!ui.views.image_error.empty())
    draw_badge({list, visible}, color_of(Role::bad), "no image", ui.views.image_error);
}

}  // namespace

/// The comparison without controls, for screenshots, snapshots and movies.
void compare_alone(const PanelContext& ui, const Rectangle& place) {
  const int frame = update_image(ui);
  ViewOptions options = view_options(ui, ui.views);
  options.compare_zoom = ui.state.view.compare_zoom;
  draw_compare_view(
      {*ImGui::GetBackgroundDrawList(), screen_rect(place)},
      compared_results(ui.state),
      CompareFrame{*shown_recording(ui.state), frame, shown_image(ui.views), options});
}

void compare_panel(const PanelContext& ui, const Rectangle& place) {
  const PanelScope scope("compare", place, {0, 0});
  if (!ui.state.document.recording)
    return draw_empty(place, "Open a recording to compare methods on it");
  const int frame = update_image(ui);
  const float chips = compare_chips(ui, place);
  const Rectangle below{place.x, place.y + chips, place.width, place.height - chips};
  const ScreenRect rest = draw_caption(ui, below, *ImGui::GetWindowDrawList());
  const Rectangle visible = to_rectangle(rest);
  ImGui::SetCursorScreenPos({visible.x, visible.y});
  // The wheel zooms, so only the scroll bar scrolls.
  const ImVec2 size(visible.width, std::max(1.0F, visible.height));
  ImGui::BeginChild("columns", size, false, ImGuiWindowFlags_NoScrollWithMouse);
  draw_columns(ui, frame, rest);
  ImGui::EndChild();
}

}  // namespace gpo
