// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/experiment/configuration.h"
#include "engine/pipeline/method_defaults.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/panes/view_options.h"
#include "ui/panels/widgets.h"
#include "ui/views/compare/compare_view.h"
#include "ui/views/overlay/overlay.h"
#include "ui/workbench/compared.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {

namespace {

constexpr float kHeight = 24, kGap = 6;  // of a chip, at scale 1 [px]

/// Puts the next chip of this width beside the last one, or below it where there is no room.
void place_next(float& x, float& y, float width, const Rectangle& place, float s) {
  if (x > place.x + kGap * s && x + width > place.right() - kGap * s) {
    x = place.x + kGap * s;
    y += (kHeight + kGap) * s;
  }
  ImGui::SetCursorScreenPos({std::round(x), std::round(y)});
  x += width + kGap * s;
}

/// Whether its x was clicked.
bool draw_cross(const std::string& key, const ImVec2& at, float side, bool dim) {
  ImGui::SetCursorScreenPos(at);
  const bool clicked = hit_area(("remove " + key).c_str(), {side, side});
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool hovered = ImGui::IsItemHovered() && !dim;
  const ImU32 color = imgui_color(hovered ? Role::text : Role::text_dim, dim ? 0.35 : 1);
  const ImVec2 middle(at.x + side / 2, at.y + side / 2);
  const float arm = side * 0.17F;
  list.AddLine({middle.x - arm, middle.y - arm}, {middle.x + arm, middle.y + arm}, color, 1.5F);
  list.AddLine({middle.x - arm, middle.y + arm}, {middle.x + arm, middle.y - arm}, color, 1.5F);
  tooltip(dim ? "The last one stays" : "Removes it from the comparison");
  return clicked;
}

/// `key`: as it is among the compared ones; `one`: what it comes to in the window.
void chip(const std::string& key,
          const Configuration& one,
          bool last,
          float width,
          float s,
          Commands& commands) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float height = std::round(kHeight * s);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float round = 4 * s;
  list.AddRectFilled(at, {at.x + width, at.y + height}, imgui_color(Role::raised), round);
  list.AddRectFilled(at,
                     {at.x + std::round(5 * s), at.y + height},
                     imgui_color(color_of(one)),
                     round,
                     ImDrawFlags_RoundCornersLeft);
  list.AddText(
      {at.x + std::round(12 * s), std::round(at.y + (height - ImGui::GetTextLineHeight()) / 2)},
      imgui_color(Role::text),
      title_of(one).c_str());
  const bool remove = draw_cross(key, {at.x + width - height, at.y}, height, last);
  if (remove && !last) push(commands, RunAction{"compare remove " + key});
}

/// The current settings, as they are or with the other RANSAC, beside what is compared.
Configuration current(const WorkbenchState& state, std::optional<bool> ransac) {
  Settings settings = state.document.settings;
  if (ransac) settings.options.ransac = ransac;
  return called_among_compared(state, settings);
}

void entry(const PanelInput& input,
           const Configuration& one,
           const std::string& title,
           Commands& commands) {
  const std::string key = key_of(one);
  const auto& compared = input.state.document.compared;
  const bool there = std::ranges::find(compared, one) != compared.end();
  const float side = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + side * 0.15F},
                                            {at.x + side * 0.35F, at.y + side * 0.85F},
                                            imgui_color(color_of(one)),
                                            side * 0.1F);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + side * 0.7F);
  if (ImGui::MenuItem(fmt::format("{}##{}", title, title + key).c_str(), nullptr, there))
    push(commands, RunAction{(there ? "compare remove " : "compare add ") + key});
}

void list_of_all(const PanelInput& input, Commands& commands) {
  if (!ImGui::BeginPopup("add")) return;
  heading("CURRENT SETTINGS");
  const WorkbenchState& state = input.state;
  const Configuration now = current(state, {});
  entry(input, now, title_of(configuration_of(state.document.settings)), commands);
  const bool ransac = uses_ransac(state.document.settings.options);
  entry(input,
        current(state, !ransac),
        fmt::format("the same {} RANSAC", ransac ? "without" : "with"),
        commands);
  ImGui::Separator();
  heading("METHODS AND ABLATIONS");
  for (const Configuration& one : parse_configurations("all", state.methods))
    entry(input, one, title_of(one), commands);
  ImGui::Separator();
  if (ImGui::MenuItem("The paper's four")) push(commands, RunAction{"compare paper"});
  if (ImGui::MenuItem("All of them")) push(commands, RunAction{"compare all"});
  ImGui::EndPopup();
}

/// What is compared, in rows at the top of a panel: a chip each in its method's color with an x
/// that removes it, and a "+" that lists what can be added. Returns how high that is [px].
float compare_chips(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const float s = input.scale;
  const auto& compared = input.state.document.compared;
  float x = place.x + kGap * s, y = place.y + kGap * s;
  const std::vector<Settings> settings =
      compared_settings(input.state, input.state.document.settings);
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const Configuration one = called_among_compared(input.state, settings[i]);
    const float width =
        std::round(ImGui::CalcTextSize(title_of(one).c_str()).x + (12 + kHeight) * s);
    place_next(x, y, width, place, s);
    chip(key_of(compared[i]), one, compared.size() == 1, width, s, commands);
  }
  const float side = std::round(kHeight * s);
  place_next(x, y, side, place, s);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
  if (ImGui::Button("+", {side, side})) ImGui::OpenPopup("add");
  ImGui::PopStyleVar();
  tooltip("Compare also: every method, and the current settings with and without RANSAC");
  list_of_all(input, commands);
  return std::round(y + (kHeight + kGap) * s - place.y);
}

using Eigen::Vector2d;

Rectangle to_rectangle(const ScreenRect& rect) {
  return {static_cast<float>(rect.min.x()),
          static_cast<float>(rect.min.y()),
          static_cast<float>(rect.size.x()),
          static_cast<float>(rect.size.y())};
}

/// An invisible button there.
void button(const std::string& name, const ScreenRect& rect) {
  const Rectangle place = to_rectangle(rect);
  ImGui::SetCursorScreenPos({place.x, place.y});
  hit_area(name.c_str(), {place.width, place.height});
}

/// The wheel zooms in all columns around the same point of the picture, dragging moves all, a
/// double click shows all of the picture, or again the surroundings of the cubes.
void zoom_and_pan(const ScreenRect& rect,
                  const ImageZoom& zoom,
                  const WorkbenchState& state,
                  Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const Camera& camera = state.document.recording->camera;
  const Vector2d at(io.MousePos.x, io.MousePos.y), by(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsItemHovered() && io.MouseWheel != 0)
    push(commands, ZoomCompare{zoom_about(zoom, camera, rect, at, std::pow(1.25, io.MouseWheel))});
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    const bool whole = state.view.compare_zoom && state.view.compare_zoom->factor <= 1;
    push(commands, ZoomCompare{whole ? std::nullopt : std::optional(ImageZoom{})});
  } else if (ImGui::IsItemActive() && !by.isZero()) {
    push(commands, ZoomCompare{pan(zoom, camera, rect, by)});
  }
}

void choose_by_heading(const PanelInput& input,
                       const ColumnPlace& place,
                       const Compared& one,
                       const std::string& name,
                       Commands& commands) {
  button("heading " + name, place.heading);
  if (ImGui::IsItemClicked()) push(commands, ChangeSettings{one.settings});
  const bool current =
      called_among_compared(input.state, input.state.document.settings) == one.configuration;
  const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered() && !current) list.AddRectFilled(a, b, imgui_color(Role::hovered, 0.5));
  if (current)  // as a tab that is open
    list.AddRectFilled({a.x, b.y - std::round(2 * input.scale)}, b, imgui_color(Role::accent));
  tooltip(current ? "The current method: settings and results at the left are its"
                  : "Click: makes it the current method");
}

/// Below the chips: what is seen. Returns what is left for the columns.
ScreenRect draw_caption(const PanelInput& input, const Rectangle& place, ImDrawList& list) {
  const float s = input.scale;
  const WorkbenchState& state = input.state;
  const float height = std::round(22 * s);
  const int first = state.document.settings.start,
            last = first + state.document.settings.frames - 1;
  const bool inside = state.view.frame >= first && state.view.frame <= last;
  const std::string text = fmt::format("frame {}{} window {}–{}{}",
                                       state.view.frame,
                                       inside ? " of the" : ", outside of the",
                                       first,
                                       last,
                                       state.view.flip ? " · first two swapped" : "");
  const Vector2d at(place.x + 12 * s, place.y + 4 * s);
  write_text(list, Font::small, at, text, color_of(Role::text_dim));
  const auto width = static_cast<float>(text_width(Font::small, text));
  const bool truth =
      state.results.inspection && state.results.inspection->truth && state.view.toggles.truth;
  if (inside && place.width > width + 330 * s)
    draw_cube_legend(list, {place.x + 42 * s + width, place.y + 3 * s}, truth);
  return {{place.x, place.y + height}, {place.width, place.height - height}};
}

/// The columns of a frame, where they are less high than a person can use, within what can be
/// scrolled.
void draw_columns(const PanelInput& input,
                  int frame,
                  const ScreenRect& visible,
                  Views& views,
                  Commands& commands) {
  constexpr double kLeastHeight = 190, kLeastRow = 290;  // of one row, of each of many [px]
  const WorkbenchState& state = input.state;
  const std::vector<Compared> results = compared_results(state);
  const std::vector<CompareColumn> columns = compare_columns(results);
  const int count = static_cast<int>(columns.size());
  const int rows = (count + 3) / 4;
  const double least = input.scale * (rows > 1 ? rows * kLeastRow : kLeastHeight);
  const bool scrolls = least > visible.size.y();
  const ImVec2 origin = ImGui::GetCursorScreenPos();  // moves as one scrolls
  ScreenRect rect{{origin.x, origin.y}, visible.size};
  if (scrolls) rect.size = {visible.size.x() - ImGui::GetStyle().ScrollbarSize, least};
  ViewOptions options = view_options(state, views);
  options.compare_zoom = state.view.compare_zoom;
  options.top_line = false;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const CompareFrame shown{.recording = *state.document.recording,
                           .frame = frame,
                           .image = shown_image(views),
                           .options = options};
  draw_compare_view(list, rect, columns, shown);
  const auto places =
      compare_places(rect, count, aspect_of(state.document.recording->camera), options.top_line);
  const ImageZoom zoom = compare_zoom(columns, shown, places.front().image.size);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::string name = key_of(results[i].configuration);
    choose_by_heading(input, places[i], results[i], name, commands);
    button("picture " + name, places[i].image);
    zoom_and_pan(places[i].image, zoom, state, commands);
  }
  if (scrolls) {
    ImGui::SetCursorScreenPos({origin.x, origin.y + static_cast<float>(least) - 1});
    ImGui::Dummy({1, 1});
  }
  if (!views.image_error.empty())
    draw_badge(list, visible, color_of(Role::bad), "no picture", views.image_error);
}

}  // namespace

void compare_panel(const PanelInput& input,
                   const Rectangle& place,
                   Views& views,
                   Commands& commands) {
  const PanelScope panel("compare", place, {0, 0});
  const WorkbenchState& state = input.state;
  if (!state.document.recording)
    return draw_empty(place, "Open a recording to compare methods on it");
  const int frame = update_image(input, views);
  const float chips = compare_chips(input, place, commands);
  const Rectangle below{place.x, place.y + chips, place.width, place.height - chips};
  const ScreenRect rest = draw_caption(input, below, *ImGui::GetWindowDrawList());
  const Rectangle visible = to_rectangle(rest);
  ImGui::SetCursorScreenPos({visible.x, visible.y});
  // The wheel zooms; what is too high is scrolled by its bar.
  ImGui::BeginChild("columns",
                    {visible.width, std::max(1.0F, visible.height)},
                    false,
                    ImGuiWindowFlags_NoScrollWithMouse);
  draw_columns(input, frame, rest, views, commands);
  ImGui::EndChild();
}

}  // namespace gpo
