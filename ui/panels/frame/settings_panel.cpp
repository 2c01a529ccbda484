// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/methods.h"
#include "ui/context/gui.h"
#include "ui/look/palette.h"
#include "ui/panels/facts/facts.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/setting_text.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr const char* kDrag = ". Drag, or double-click to type";

/// What few people change; folded away.
bool is_advanced(const SettingInfo& info) {
  static const std::set<std::string> keys = {
      "inliers", "seed", "exclude", "solver", "error", "loss", "shutter", "time_offset"};
  return keys.contains(info.key);
}

/// One visit a setting: label to the left, the widget that fits its type to the right; dim, with
/// the reason, where it changes nothing. `changed` tells whether the user changed one.
struct SettingRows {
  const PanelInput& input;
  Commands& commands;
  float label_width;
  bool advanced = false;  ///< which of the settings are shown
  bool changed = false;
  std::string idle = {};  ///< why the setting at hand does nothing

  template <class Value>
  void operator()(const SettingInfo& info, Value& value) {
    if (is_advanced(info) != advanced) return;
    idle = why_idle(input.state.settings, info.key);
    const std::string normal = setting_text(Settings{}, info.key);
    const bool other = setting_text(input.state.settings, info.key) != normal;
    ImGui::BeginDisabled(!idle.empty());
    ImGui::PushID(info.key);
    label(info.title, idle.empty() ? info.help : idle.c_str(), other);
    widget(info, value);
    ImGui::PopID();
    ImGui::EndDisabled();
    if (other && ImGui::IsItemClicked(ImGuiMouseButton_Right))
      push(commands, RunAction{std::string("reset ") + info.key});
  }

  /// Of the item drawn last.
  void explain(const SettingInfo& info, const char* how = "") const {
    const std::string unit = *info.unit == '\0' ? "" : fmt::format(" [{}]", info.unit);
    const std::string normal = setting_text(Settings{}, info.key);
    tooltip(
        idle.empty()
            ? fmt::format("{}{}{}\nDefault: {}; right click resets", info.help, unit, how, normal)
            : idle);
  }

  bool begin_combo(const SettingInfo& info, const char* title) const {
    if (ImGui::BeginCombo((std::string("##") + info.key).c_str(), title)) return true;
    explain(info);
    return false;
  }

  /// In the color of what was chosen, where it is `other` than the default.
  void label(const char* title, const char* help, bool other = false) const {
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(other ? palette::kAccent : palette::kText));
    ImGui::TextUnformatted(title);
    ImGui::PopStyleColor();
    tooltip(help);
    ImGui::SameLine(label_width);
    ImGui::SetNextItemWidth(-1);
  }

  int most_of(const SettingInfo& info) const {
    const int frames = input.state.frame_count();
    return frames > 0 ? std::min(static_cast<int>(info.most), frames) : static_cast<int>(info.most);
  }

  void widget(const SettingInfo& info, int& value) {
    changed |= ImGui::DragInt((std::string("##") + info.key).c_str(),
                              &value,
                              0.25F,
                              static_cast<int>(info.least),
                              most_of(info),
                              "%d",
                              ImGuiSliderFlags_AlwaysClamp);
    explain(info, kDrag);
  }

  void widget(const SettingInfo& info, std::uint64_t& value) {
    const auto least = static_cast<std::uint64_t>(info.least);
    const auto most = static_cast<std::uint64_t>(info.most);
    changed |= ImGui::DragScalar((std::string("##") + info.key).c_str(),
                                 ImGuiDataType_U64,
                                 &value,
                                 0.1F,
                                 &least,
                                 &most,
                                 "%llu",
                                 ImGuiSliderFlags_AlwaysClamp);
    explain(info, kDrag);
  }

  void widget(const SettingInfo& info, double& value) {
    const std::string format = fmt::format("%.1f {}", info.unit);
    changed |= ImGui::DragScalar((std::string("##") + info.key).c_str(),
                                 ImGuiDataType_Double,
                                 &value,
                                 0.02F,
                                 &info.least,
                                 &info.most,
                                 format.c_str(),
                                 ImGuiSliderFlags_AlwaysClamp);
    explain(info, kDrag);
  }

  void widget(const SettingInfo& info, std::optional<bool>& value) {
    bool used = uses_ransac(input.state.settings);
    if (ImGui::Checkbox((std::string("##") + info.key).c_str(), &used)) {
      value = used;
      changed = true;
    }
    explain(info);
  }

  void widget(const SettingInfo& info, std::string& value) {
    const auto table = methods();
    const auto chosen = std::find_if(
        table.begin(), table.end(), [&](const Method& method) { return method.key == value; });
    const std::string& title = chosen == table.end() ? value : chosen->title;
    if (!begin_combo(info, title.c_str())) return;
    for (const Method& method : table) {
      ImGui::PushStyleColor(ImGuiCol_Text, imgui_color(method.rgb));
      ImGui::Bullet();
      ImGui::PopStyleColor();
      if (ImGui::Selectable(method.title.c_str(), method.key == value)) {
        value = method.key;
        changed = true;
      }
    }
    ImGui::EndCombo();
  }

  std::string source_title(RotationSource source) const {
    if (source != RotationSource::automatic || !input.state.recording) return to_string(source);
    const bool gyro = why_no_rotations(*input.state.recording, RotationSource::gyro).empty();
    return std::string(to_string(source)) + (gyro ? " (gyro)" : " (averaging)");
  }

  void widget(const SettingInfo& info, RotationSource& value) {
    if (!begin_combo(info, source_title(value).c_str())) return;
    for (std::size_t i = 0; i < rotation_source_keys().size(); ++i) {
      const auto source = static_cast<RotationSource>(i);
      const std::string why_not =
          input.state.recording ? why_no_rotations(*input.state.recording, source) : "";
      const auto flags = why_not.empty() ? 0 : ImGuiSelectableFlags_Disabled;
      if (ImGui::Selectable(source_title(source).c_str(), source == value, flags)) {
        value = source;
        changed = true;
      }
      tooltip(why_not);
    }
    ImGui::EndCombo();
  }

  void widget(const SettingInfo& info, std::vector<std::int64_t>& value) {
    ImGui::TextUnformatted(value.empty() ? "none"
                                         : fmt::format("{}", fmt::join(value, ",")).c_str());
    explain(info);
  }

  template <Choice E>
  void widget(const SettingInfo& info, E& value) {
    choose(info, value, value);
  }

  void widget(const SettingInfo& info, std::optional<Inliers>& value) {
    choose(info, value, inliers_used(input.state.settings));
  }

  void widget(const SettingInfo& info, bool& value) {
    changed |= ImGui::Checkbox((std::string("##") + info.key).c_str(), &value);
    explain(info);
  }

  /// A combo box; `value` is a choice, or an optional one that comes to `used`.
  template <Choice E>
  void choose(const SettingInfo& info, auto& value, E used) {
    if (!begin_combo(info, to_string(used))) return;
    for (std::size_t i = 0; i < ChoiceKeys<E>::keys.size(); ++i) {
      const auto each = static_cast<E>(i);
      if (!ImGui::Selectable(to_string(each), each == used)) continue;
      value = each;
      changed = true;
    }
    ImGui::EndCombo();
  }
};

void cube_row(const SettingRows& rows, const PanelInput& input, Commands& commands) {
  const char* help =
      "Side of the cube, in distances of the plane. 0: automatic, or whole squares of a chessboard";
  rows.label("Cube side", help);
  double side = input.state.cube_side;
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
  const Settings& settings = input.state.settings;
  if (settings == with_defaults(settings)) return;
  const char* title = "reset";
  ImGui::PushFont(font(Font::small));
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x -
                       ImGui::CalcTextSize(title).x - 8 * input.scale);
  if (ImGui::SmallButton(title)) push(commands, RunAction{"reset"});
  ImGui::PopFont();
  tooltip("All settings but the window and the method to their defaults; Ctrl+Z takes it back");
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
  Settings settings = input.state.settings;
  visit_settings(settings, rows);
  cube_row(rows, input, commands);
  if (ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_NoTreePushOnOpen)) {
    rows.advanced = true;
    visit_settings(settings, rows);
  }
  tooltip("Inliers, seed, and what the optimizations let one choose");
  if (rows.changed) push(commands, ChangeSettings{settings, ImGui::IsMouseDown(0)});
  ImGui::PopStyleVar(2);
}

}  // namespace gpo
