// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The left column: settings above, results below.
#include "engine/inspection/report/report.h"
#include "engine/planes/inliers.h"
#include "ui/context/imgui_versions.h"
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr ImGuiSliderFlags kClamped = ImGuiSliderFlags_AlwaysClamp;
constexpr const char* kDrag = ". Drag, or click to type";

/// One row for each setting: label and widget; dim, with the reason, if it has no effect.
struct SettingRows {
  const PanelContext& ui;
  float label_width;
  Settings settings = ui.state.document.settings;  ///< with the user's changes
  bool changed = false;
  std::string idle = {};  ///< why the current setting has no effect

  void draw(bool advanced) {
    for (const Setting& setting : settings_table())
      if (setting.advanced == advanced) draw(setting);
  }

  void draw(const Setting& setting) {
    const Settings& now = ui.state.document.settings;
    idle = why_idle(setting, now, ui.state.document.recording.get());
    const bool other = setting.get(now) != setting.get(Settings{});
    ImGui::BeginDisabled(!idle.empty());
    ImGui::PushID(setting.key.c_str());
    label(setting.title, idle.empty() ? setting.help : idle, other);
    widget(setting);
    ImGui::PopID();
    ImGui::EndDisabled();
    if (other && ImGui::IsItemClicked(ImGuiMouseButton_Right))
      push(ui.commands, RunAction{"reset " + setting.key});
  }

  void widget(const Setting& setting) {
    const SettingValue value =
        setting.used != nullptr ? setting.used(settings) : setting.get(settings);
    if (setting.by_hand && setting.kind != SettingKind::choice) {
      ImGui::TextUnformatted(value_text(value).c_str());
      return explain(setting);
    }
    switch (setting.kind) {
      case SettingKind::on_off:
        return check_box(setting, std::get<bool>(value));
      case SettingKind::whole:
        return drag(setting, std::get<std::int64_t>(value), 0.25F, "%lld");
      case SettingKind::number:
        return drag(setting, number_used(setting, value), 0.02F, "%.1f " + setting.unit);
      case SettingKind::choice:
        return combo(setting, std::get<std::string>(value));
      case SettingKind::ids:
      case SettingKind::keys:
      case SettingKind::point_pair:
      case SettingKind::masks:
        break;
    }
  }

  /// Returns the number, or the latest inspection's if it is left to the window.
  double number_used(const Setting& setting, const SettingValue& value) const {
    if (const double* given = std::get_if<double>(&value)) return *given;
    const auto& inspection = ui.state.results.inspection;
    const SettingValue used =
        inspection ? setting.get(settings_used(*inspection)) : SettingValue(kUsualThreshold);
    return std::get<double>(used);
  }

  void change(const Setting& setting, const SettingValue& value) {
    set_value(settings, setting, value, ui.state.methods);
    changed = true;
  }

  void explain(const Setting& setting, const char* how = "") const {
    if (!idle.empty()) return tooltip(idle);
    tooltip(fmt::format("{}{}{}\nDefault: {}. Right-click to reset",
                        setting.help,
                        setting.unit.empty() ? "" : fmt::format(" [{}]", setting.unit),
                        how,
                        setting_text(Settings{}, setting.key)));
  }

  /// `other`: the value is not the default.
  void label(const std::string& title, const std::string& help, bool other = false) const {
    ImGui::AlignTextToFramePadding();
    colored_text(other ? Role::accent : Role::text, title);
    tooltip(help);
    ImGui::SameLine(label_width);
    ImGui::SetNextItemWidth(-1);
  }

  template <class Number>
  void drag(const Setting& setting, Number value, float speed, const std::string& format) {
    // The window must not exceed the recording.
    const int frames = ui.state.frame_count();
    const bool window = setting.stage == SettingStage::tracks && frames > 0;
    const auto least = static_cast<Number>(setting.least);
    const auto most =
        static_cast<Number>(window ? std::min<double>(setting.most, frames) : setting.most);
    const auto type = std::is_same_v<Number, double> ? ImGuiDataType_Double : ImGuiDataType_S64;
    const std::string id = "##" + setting.key;
    const bool dragged =
        ImGui::DragScalar(id.c_str(), type, &value, speed, &least, &most, format.c_str(), kClamped);
    if (dragged && !number_is_being_typed()) change(setting, value);
    explain(setting, kDrag);
  }

  void check_box(const Setting& setting, bool on) {
    if (ImGui::Checkbox(("##" + setting.key).c_str(), &on)) {
      settings = switched(settings, setting.key, on);
      changed = true;
    }
    explain(setting);
  }

  /// Returns why the recording does not offer a choice; empty if it does.
  std::string why_not(const Setting& setting, const SettingChoice& one) const {
    const bool asks = setting.why_not != nullptr && ui.state.document.recording;
    return asks ? setting.why_not(*ui.state.document.recording, one.key) : "";
  }

  /// "automatic (gyro-calibrated)": with what the recording makes of it.
  std::string title_of(const SettingChoice& one) const {
    if (one.key != "automatic" || !ui.state.document.recording) return one.title;
    return fmt::format("{} ({})", one.title, automatic_rotations(*ui.state.document.recording));
  }

  void combo(const Setting& setting, const std::string& chosen) {
    const std::vector<SettingChoice> choices = choices_of(setting, ui.state.methods);
    const auto now = std::ranges::find(choices, chosen, &SettingChoice::key);
    const std::string title = now == choices.end() ? chosen : title_of(*now);
    if (!ImGui::BeginCombo(
            ("##" + setting.key).c_str(), title.c_str(), ImGuiComboFlags_HeightLargest))
      return explain(setting);
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
      const bool describes = lacks.empty() && setting.key == "method";
      tooltip(describes ? ui.state.methods.find(one.key).row().help : lacks);
    }
    ImGui::EndCombo();
  }
};

void preset_row(SettingRows& rows) {
  const char* help = "Sets all settings: to the best known ones, or to those of the paper";
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

void cube_row(const SettingRows& rows) {
  const std::string help =
      "Side of the cube in plane distances d. 0: automatic, or whole squares of a chessboard";
  rows.label("Cube side", help);
  double side = rows.ui.state.document.cube_side;
  const double least = 0, most = 2;
  const char* format = side > 0 ? "%.2f d" : "automatic";
  if (ImGui::DragScalar(
          "##cube_side", ImGuiDataType_Double, &side, 0.002F, &least, &most, format, kClamped))
    push(rows.ui.commands, SetCubeSide{side, current_drag()});
  tooltip(help + kDrag);
}

/// At the right of the heading, if any setting differs from its default.
void reset_button(const PanelContext& ui) {
  const Settings& settings = ui.state.document.settings;
  const int frames = ui.state.frame_count();
  if (settings == (frames > 0 ? fit_window({}, frames) : Settings{})) return;
  ImGui::PushFont(font(Font::small));
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x -
                       ImGui::CalcTextSize("reset").x - 8 * ui.scale);
  if (ImGui::SmallButton("reset")) push(ui.commands, RunAction{"reset"});
  ImGui::PopFont();
  tooltip("Resets all settings including window and method. Ctrl+Z to undo");
}

/// Left and right edge of the rows, and the gap between their parts [px from the panel's edge].
struct RowPlace {
  float left, right, gap;
  float uncertainty = 0;  ///< width of the column at the right
};

/// Draws a small dim note from `left` on. Returns false if it does not fit before `right`.
bool draw_note_after(const std::string& note, float left, float right) {
  ImGui::PushFont(font(Font::small));
  const bool fits = left + ImGui::CalcTextSize(note.c_str()).x <= right;
  if (fits) {
    continue_line_at(left);
    colored_text(Role::text_dim, note);
  }
  ImGui::PopFont();
  return fits;
}

/// Draws a small dim note that ends before `right`. Returns false if there is no room for it.
bool draw_note(const std::string& note, float right, float gap) {
  const float drawn_to = ImGui::GetItemRectMax().x - ImGui::GetWindowPos().x;
  ImGui::PushFont(font(Font::small));
  const float left = right - ImGui::CalcTextSize(note.c_str()).x - gap;
  ImGui::PopFont();
  return left > drawn_to + gap && draw_note_after(note, left, right);
}

/// Draws the value flush right in its column, its uncertainty in the column at the right, and its
/// note where there is room. Returns false if the note does not fit.
bool draw_value(const ResultRow& row, const RowPlace& place) {
  const auto [value, uncertainty] = value_and_uncertainty(row.value);
  const float column = place.right - place.uncertainty;
  const float left = column - ImGui::CalcTextSize(value.c_str()).x;
  const bool fits = row.note.empty() || draw_note(row.note, left, place.gap);
  continue_line_at(left);
  colored_text(row.color, value);
  const float after = column + place.gap / 2;
  if (uncertainty.empty()) return fits || draw_note_after(row.note, after, place.right);
  continue_line_at(after);
  colored_text(row.color, uncertainty);
  return fits;
}

/// Right click: a menu that copies the number.
void number_menu(const PanelContext& ui, const ResultRow& row) {
  if (!right_clicked(ui.scale)) return;
  const auto [value, uncertainty] = value_and_uncertainty(row.value);
  open_context_menu(ui,
                    {{.kind = ContextKind::number,
                      .title = row.label + " " + row.value,
                      .value = value.empty() ? uncertainty : value,
                      .uncertain = uncertainty.empty() || value.empty() ? "" : row.value}});
}

void draw_row(const PanelContext& ui, const ResultRow& row, const RowPlace& place) {
  ImGui::SetCursorPosX(place.left);
  ImGui::BeginGroup();
  const std::string value = value_and_uncertainty(row.value).first + " ";
  fitted_text(row.label, place.right - place.uncertainty - ImGui::CalcTextSize(value.c_str()).x);
  const bool fits = draw_value(row, place);
  ImGui::EndGroup();
  number_menu(ui, row);
  tooltip(fits ? row.tooltip : row.note + ". " + row.tooltip);
}

/// Draws many short rows in two columns and the small font.
void draw_pairs(const PanelContext& ui, const ResultGroup& group, const RowPlace& place) {
  ImGui::PushFont(font(Font::small));
  const float middle = std::round((place.left + place.right) / 2);
  for (std::size_t i = 0; i < group.rows.size(); ++i) {
    if (i % 2 == 1) ImGui::SameLine();
    const RowPlace first{place.left, middle - place.gap, place.gap};
    const RowPlace second{middle + place.gap, place.right, place.gap};
    draw_row(ui, group.rows[i], i % 2 == 1 ? second : first);
  }
  ImGui::PopFont();
}

/// Draws the verdict as sign and word, its normal uncertainty at the right, and the reason below.
void draw_verdict(const PanelContext& ui, const Initialization& result, const RowPlace& place) {
  const Verdict verdict = result.verdict.value_or(Verdict{});
  const bool judged = result.verdict && (result.ok || verdict.readiness == Readiness::degenerate);
  const SignStyle look = judged      ? style_of(verdict.readiness)
                         : result.ok ? SignStyle{Sign::none, color_of(Role::text_dim)}
                                     : SignStyle{Sign::cross, color_of(Role::bad)};
  const std::string word = judged      ? to_string(verdict.readiness)
                           : result.ok ? "not judged"
                                       : "failed";
  ImGui::SetCursorPosX(place.left);
  ImGui::BeginGroup();
  ImGui::PushFont(font(Font::heading));
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 middle(at.x + 6 * ui.scale, at.y + ImGui::GetTextLineHeight() / 2);
  draw_sign(*ImGui::GetWindowDrawList(), look.sign, middle, look.rgb);
  ImGui::SetCursorPosX(std::round(place.left + 18 * ui.scale));
  colored_text(look.rgb, word);
  const NormalSigma sigma = shown_normal_sigma(result);
  if (!sigma.of_result && !sigma.text.empty()) draw_note(sigma.text, place.right, 0);
  if (sigma.of_result) {
    const float left = place.right - ImGui::CalcTextSize(sigma.text.c_str()).x;
    draw_note("normal", left, place.gap);
    continue_line_at(left);
    ImGui::TextUnformatted(sigma.text.c_str());
  }
  ImGui::PopFont();
  ImGui::PushFont(font(Font::small));
  const std::string& reason = result.ok || result.reason.empty() ? verdict.reason : result.reason;
  if (!is_said_by(finding_rows(ui.inspection()), reason)) wrapped_text(reason, place.right);
  ImGui::PopFont();
  ImGui::EndGroup();
  if (judged) tooltip("Verdict on the window: " + verdict_text(verdict));
}

/// Returns whether the mouse is over the settings or holds one of them: they must not move then.
bool settings_in_use(const Views& views) {
  const Rectangle& place = views.settings;
  const Vector2d mouse = mouse_px();
  const bool over = mouse.x() >= place.x && mouse.x() < place.right() && mouse.y() >= place.y &&
                    mouse.y() < place.bottom();
  return over || ImGui::IsAnyItemActive();
}

void draw_state(const PanelInput& input, float right) {
  const bool stale =
      input.inspection() && !(input.inspection()->settings == input.state.document.settings);
  const char* text = input.opening       ? input.inspection() ? "of the old recording" : ""
                     : input.worker.busy ? "computing"
                     : stale             ? "from earlier settings"
                                         : "";
  ImGui::PushFont(font(Font::small));
  continue_line_at(right - ImGui::CalcTextSize(text).x);
  colored_text(Role::warning, text);
  ImGui::PopFont();
}

}  // namespace

void settings_panel(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const PanelScope scope("settings", place, {12 * s, 8 * s}, PanelKind::scrolling);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {8 * s, 3 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 4 * s});
  heading("SETTINGS");
  reset_button(ui);
  SettingRows rows{ui, std::round(104 * s)};
  preset_row(rows);
  rows.draw(false);
  cube_row(rows);
  const bool advanced = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_NoTreePushOnOpen);
  if (ImGui::IsItemToggledOpen()) ImGui::SetScrollHereY(0);
  tooltip("Shows inlier selection, seed, and options of the optimization");
  if (advanced) rows.draw(true);
  if (rows.changed) push(ui.commands, ChangeSettings{rows.settings, current_drag()});
  ui.views.settings = place;
  ui.views.settings_height = std::round(ImGui::GetCursorPosY() + 6 * s);
  ImGui::PopStyleVar(2);
}

void verdict_panel(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const PanelScope scope("verdict", place, {12 * s, 6 * s}, PanelKind::scrolling);
  const float left = ImGui::GetCursorPosX();
  const RowPlace rows{left, left + ImGui::GetContentRegionAvail().x, std::round(8 * s)};
  const Initialization* result = ui.inspection() ? ui.inspection()->initialization.get() : nullptr;
  heading("VERDICT");
  draw_state(ui, rows.right);
  if (result != nullptr)
    draw_verdict(ui, *result, rows);
  else
    text_in(Font::heading, color_of(Role::text_dim), "\u2013");
  findings_group(ui, rows.left, rows.right);
  const float height = std::round(ImGui::GetCursorPosY() + 4 * s);
  if (ui.views.verdict_height == 0 || !settings_in_use(ui.views)) ui.views.verdict_height = height;
}

void results_panel(const PanelContext& ui, const Rectangle& place) {
  const float s = ui.scale;
  const PanelScope scope("results", place, {12 * s, 4 * s}, PanelKind::scrolling);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 3 * s});
  const float left = ImGui::GetCursorPosX();
  RowPlace rows{left, left + ImGui::GetContentRegionAvail().x, std::round(8 * s)};
  const auto groups = result_groups(ui.inspection(), ui.timings, ui.state.document.cube_side);
  for (const ResultGroup& group : groups)
    for (const ResultRow& row : group.rows) {
      const std::string uncertainty = value_and_uncertainty(row.value).second;
      const float width = ImGui::CalcTextSize(uncertainty.c_str()).x + rows.gap / 2;
      if (!uncertainty.empty()) rows.uncertainty = std::max(rows.uncertainty, std::round(width));
    }
  std::string unknown;
  for (const ResultGroup& group : groups) {
    if (!has_values(group)) {
      unknown += (unknown.empty() ? "" : "\n") + why_no_values(group);
      continue;
    }
    heading(group.title.c_str());
    if (group.title == kTimeTitle)
      draw_pairs(ui, group, {rows.left, rows.right, rows.gap});
    else
      for (const ResultRow& row : group.rows) draw_row(ui, row, rows);
    ImGui::Dummy({1, 2 * s});
  }
  if (!unknown.empty()) {
    heading("Groups without values are hidden");
    tooltip(unknown);
  }
  ImGui::PopStyleVar();
}

}  // namespace gpo
