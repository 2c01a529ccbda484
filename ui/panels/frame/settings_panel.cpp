// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings/setting_values.h"
#include "engine/inspection/window/window_inputs.h"
#include "engine/methods/methods.h"
#include "ui/context/gui.h"
#include "ui/context/imgui_versions.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/time_span.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr const char* kDrag = ". Drag, or double-click to type";

/// One row a setting: label to the left, the widget that fits its kind to the right; dim, with the
/// reason, where it changes nothing. `changed` tells whether the user changed one.
struct SettingRows {
  const PanelInput& input;
  Commands& commands;
  float label_width;
  Settings settings = input.state.document.settings;  ///< as the user changes them
  bool changed = false;
  std::string idle = {};  ///< why the setting at hand does nothing

  void draw(bool advanced) {
    for (const Setting& setting : settings_table())
      if (setting.advanced == advanced) draw(setting);
  }

  void draw(const Setting& setting) {
    const Settings& now = input.state.document.settings;
    idle = why_idle(setting, now, input.state.document.recording.get());
    const bool other = setting.get(now) != setting.get(Settings{});
    ImGui::BeginDisabled(!idle.empty());
    ImGui::PushID(setting.key.c_str());
    label(setting.title, idle.empty() ? setting.help : idle, other);
    widget(setting);
    ImGui::PopID();
    ImGui::EndDisabled();
    if (other && ImGui::IsItemClicked(ImGuiMouseButton_Right))
      push(commands, RunAction{"reset " + setting.key});
  }

  void widget(const Setting& setting) {
    const SettingValue value =
        setting.used != nullptr ? setting.used(settings) : setting.get(settings);
    switch (setting.kind) {
      case SettingKind::on_off:
        return check_box(setting, std::get<bool>(value));
      case SettingKind::whole:
        return drag(setting, std::get<std::int64_t>(value), 0.25F, "%lld");
      case SettingKind::number:
        return drag(setting, std::get<double>(value), 0.02F, "%.1f " + setting.unit);
      case SettingKind::choice:
        return combo(setting, std::get<std::string>(value));
      case SettingKind::ids:
        ImGui::TextUnformatted(value_text(value).c_str());
        return explain(setting);
    }
  }

  void change(const Setting& setting, const SettingValue& value) {
    set_value(settings, setting, value, input.state.methods);
    changed = true;
  }

  /// Of the item drawn last.
  void explain(const Setting& setting, const char* how = "") const {
    const std::string unit = setting.unit.empty() ? "" : fmt::format(" [{}]", setting.unit);
    const std::string normal = setting_text(Settings{}, setting.key);
    tooltip(idle.empty()
                ? fmt::format(
                      "{}{}{}\nDefault: {}; right click resets", setting.help, unit, how, normal)
                : idle);
  }

  /// In the color of what was chosen, where it is `other` than the default.
  void label(const std::string& title, const std::string& help, bool other = false) const {
    ImGui::AlignTextToFramePadding();
    colored_text(other ? color_of(Role::accent) : color_of(Role::text), title);
    tooltip(help);
    ImGui::SameLine(label_width);
    ImGui::SetNextItemWidth(-1);
  }

  /// What chooses the window does not reach beyond the recording.
  double most_of(const Setting& setting) const {
    const int frames = input.state.frame_count();
    const bool window = setting.stage == SettingStage::tracks && frames > 0;
    return window ? std::min<double>(setting.most, frames) : setting.most;
  }

  template <class Number>
  void drag(const Setting& setting, Number value, float speed, const std::string& format) {
    const auto least = static_cast<Number>(setting.least);
    const auto most = static_cast<Number>(most_of(setting));
    const auto type = std::is_same_v<Number, double> ? ImGuiDataType_Double : ImGuiDataType_S64;
    if (ImGui::DragScalar(("##" + setting.key).c_str(),
                          type,
                          &value,
                          speed,
                          &least,
                          &most,
                          format.c_str(),
                          ImGuiSliderFlags_AlwaysClamp) &&
        !number_is_being_typed())
      change(setting, value);
    explain(setting, kDrag);
  }

  void check_box(const Setting& setting, bool on) {
    if (ImGui::Checkbox(("##" + setting.key).c_str(), &on)) {
      settings = switched(settings, setting.key, on);
      changed = true;
    }
    explain(setting);
  }

  /// Why the recording does not have a choice; empty where it does.
  std::string why_not(const Setting& setting, const SettingChoice& one) const {
    const bool asks = setting.why_not != nullptr && input.state.document.recording;
    return asks ? setting.why_not(*input.state.document.recording, one.key) : "";
  }

  /// "automatic (gyro-calibrated)": what it comes to in the recording.
  std::string title_of(const SettingChoice& one) const {
    if (one.key != "automatic" || !input.state.document.recording) return one.title;
    return fmt::format("{} ({})", one.title, automatic_rotations(*input.state.document.recording));
  }

  void combo(const Setting& setting, const std::string& chosen) {
    const std::vector<SettingChoice> choices = choices_of(setting, input.state.methods);
    const auto now = std::ranges::find(choices, chosen, &SettingChoice::key);
    const std::string title = now == choices.end() ? chosen : title_of(*now);
    if (!ImGui::BeginCombo(("##" + setting.key).c_str(), title.c_str())) return explain(setting);
    for (const SettingChoice& one : choices) {
      const std::string lacks = why_not(setting, one);
      if (one.rgb != 0) {
        ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(one.rgb));
        ImGui::Bullet();
        ImGui::PopStyleColor();
      }
      const auto flags = lacks.empty() ? 0 : ImGuiSelectableFlags_Disabled;
      if (ImGui::Selectable(title_of(one).c_str(), one.key == chosen, flags))
        change(setting, one.key);
      tooltip(lacks.empty() && setting.key == "method" ? find_method(one.key).help : lacks);
    }
    ImGui::EndCombo();
  }
};

void preset_row(SettingRows& rows) {
  const char* help = "All settings by one word: the best that we have, or what the paper does";
  rows.label("Preset", help);
  const auto now = preset_of(rows.settings);
  if (!ImGui::BeginCombo("##preset", now ? to_string(*now) : "modified")) return tooltip(help);
  for (const Preset preset : {Preset::best, Preset::paper}) {
    if (!ImGui::Selectable(to_string(preset), now == preset)) continue;
    rows.settings = with_preset(rows.settings, preset);
    rows.changed = true;
  }
  ImGui::EndCombo();
}

void cube_row(const SettingRows& rows, const PanelInput& input, Commands& commands) {
  const char* help =
      "Side of the cube, in distances of the plane. 0: automatic, or whole squares of a chessboard";
  rows.label("Cube side", help);
  double side = input.state.document.cube_side;
  const double least = 0;
  const double most = 2;
  if (ImGui::DragScalar("##cube_side",
                        ImGuiDataType_Double,
                        &side,
                        0.002F,
                        &least,
                        &most,
                        side > 0 ? "%.2f d" : "automatic",
                        ImGuiSliderFlags_AlwaysClamp)) {
    push(commands, SetCubeSide{side});
  }
  tooltip(help);
}

/// At the right of the heading, where there is something to reset.
void reset_button(const PanelInput& input, Commands& commands) {
  const Settings& settings = input.state.document.settings;
  const int frames = input.state.frame_count();
  if (settings == (frames > 0 ? fit_window({}, frames) : Settings{})) return;
  const char* title = "reset";
  ImGui::PushFont(font(Font::small));
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x -
                       ImGui::CalcTextSize(title).x - 8 * input.scale);
  if (ImGui::SmallButton(title)) push(commands, RunAction{"reset"});
  ImGui::PopFont();
  tooltip("All settings, window and method too, to their defaults; Ctrl+Z takes it back");
}

}  // namespace

void settings_panel(const PanelInput& input, const Rectangle& place, Commands& commands) {
  const float s = input.scale;
  const PanelScope panel("settings", place, {12 * s, 8 * s}, true);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {8 * s, 3 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 4 * s});
  heading("SETTINGS");
  reset_button(input, commands);
  SettingRows rows{input, commands, std::round(104 * s)};
  preset_row(rows);
  rows.draw(false);
  cube_row(rows, input, commands);
  const bool advanced = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_NoTreePushOnOpen);
  // What was asked for comes into view.
  if (ImGui::IsItemToggledOpen()) ImGui::SetScrollHereY(0);
  tooltip("Inliers, seed, and what the optimizations let one choose");
  if (advanced) rows.draw(true);
  if (rows.changed) push(commands, ChangeSettings{rows.settings, ImGui::IsMouseDown(0)});
  ImGui::PopStyleVar(2);
}

}  // namespace gpo
