// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The recording's camera and sensors, the lens as a grid, and the report of a calibration.
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kGridCells = 16;

void draw_rows(const std::vector<ResultRow>& rows, float values) {
  for (const ResultRow& row : rows) {
    const float left = ImGui::GetCursorPosX();
    ImGui::BeginGroup();
    colored_text(Role::text_dim, row.label);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left + values);  // in a table, the offset of SameLine is another
    colored_text(row.color, row.value);
    if (!row.note.empty()) {
      ImGui::SameLine();
      colored_text(Role::text_dim, row.note);
    }
    ImGui::EndGroup();
    tooltip(fmt::format("{} {}\n{}", row.value, row.note, row.tooltip));  // a column may cut it
  }
}

/// Draws lines that a pinhole camera would see as a regular grid, as this lens sees them.
void draw_grid(const Camera& camera, const Rectangle& place) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float s = overlay_scale();
  const Vector2d size(camera.width, camera.height);
  const double zoom =
      std::min((place.width - 16 * s) / size.x(), (place.height - 40 * s) / size.y());
  if (!(zoom > 0)) return;
  const Vector2d origin(place.x + 8 * s, place.y + 8 * s);
  const auto at = [&](const Vector2d& raw_px) {
    return to_imgui(origin + zoom * (raw_px + Vector2d::Constant(0.5)));
  };
  const ImVec2 low = at({-0.5, -0.5}), high = at(size - Vector2d::Constant(0.5));
  list.AddRectFilled(low, high, imgui_color(Role::raised));
  list.PushClipRect(low, high, true);
  for (const auto& line : distortion_grid(camera, kGridCells)) {
    std::vector<ImVec2> points;
    std::ranges::transform(line, std::back_inserter(points), at);
    list.AddPolyline(
        points.data(), static_cast<int>(points.size()), imgui_color(Role::accent), 0, 1.2F * s);
  }
  list.PopClipRect();
  list.AddRect(low, high, imgui_color(Role::border), 0, 0, s);
  draw_sign(list, Sign::cross, at({camera.cx, camera.cy}), color_of(Role::reference));
  Vector2d corner_px = Vector2d::Zero();
  for (const Vector2d& corner : {Vector2d(-0.5, -0.5), Vector2d(size - Vector2d::Constant(0.5))}) {
    const Vector2d shift = undistort(camera, corner) - corner;
    if (!shift.allFinite() || shift.norm() > corner_px.norm()) corner_px = shift;
  }
  const std::string text =
      corner_px.allFinite()
          ? fmt::format("Straight lines as this lens sees them. It moves corners by {:.1f} px",
                        corner_px.norm())
          : "Straight lines as this lens sees them. It sees corners beyond a pinhole's view";
  write_text(list,
             Font::small,
             Vector2d(low.x, high.y + 4 * s),
             fitting_text(Font::small, {text, "Lens"}, place.width - 16 * s),
             color_of(Role::text_dim));
}

/// Draws what a calibration changed, and two buttons.
void draw_calibration(const PanelContext& ui, const CalibrationResult& calibration, float values) {
  const float s = ui.scale;
  heading("CALIBRATION: ACCEPT IT?");
  for (const char* name : {"accept-calibration", "undo-calibration"}) {
    const Action& action = action_named(name);
    if (ImGui::Button(action.title.c_str())) push(ui.commands, RunAction{action.name});
    tooltip(action.tooltip);
    ImGui::SameLine();
  }
  ImGui::NewLine();
  draw_rows(calibration_changes(calibration.before->camera, ui.state.document.recording->camera),
            values);
  wrapped_text(calibration.report, ImGui::GetCursorPosX() + 420 * s);
}

}  // namespace

void camera_drawer(const PanelContext& ui, const Rectangle& place) {
  const auto& recording = shown_recording(ui.state);
  if (!recording) return draw_empty(place, "Camera and sensors appear when a recording is open");
  const float s = ui.scale;
  auto& cached = ui.views.recording_groups;
  cached.update(recording, [&] { return recording_groups(*recording); });
  const float grid = std::min(place.width * 0.24F, place.height * 1.5F);
  const float width = place.width - grid - 24 * s;
  ImGui::SetCursorPos({12 * s, 6 * s});
  ImGui::BeginChild("facts", {width, place.height - 6 * s});
  ImGui::PushFont(font(Font::small));
  const float values = 6.8F * ImGui::GetFontSize();
  if (const auto& calibration = ui.state.results.calibration)
    draw_calibration(ui, *calibration, values);
  const int columns = std::clamp(static_cast<int>(width / (26 * ImGui::GetFontSize())), 1, 3);
  if (ImGui::BeginTable("groups", columns, ImGuiTableFlags_SizingStretchProp)) {
    for (const ResultGroup& group : cached.value) {
      ImGui::TableNextColumn();
      heading(group.title.c_str());
      draw_rows(group.rows, values);
    }
    ImGui::EndTable();
  }
  ImGui::PopFont();
  ImGui::EndChild();
  draw_grid(recording->camera, {place.x + place.width - grid - 4 * s, place.y, grid, place.height});
}

}  // namespace gpo
