// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/widgets.h"
#include "ui/workbench/actions/actions.h"

#include <cmath>

namespace gpo {
namespace {

struct KeyRow {
  std::string keys, title, value, tooltip;
  bool on = false;
};

std::vector<KeyRow> key_rows(const WorkbenchState& state) {
  std::vector<KeyRow> rows;
  for (const Action& action : actions()) {
    if (action.shortcuts.empty()) continue;
    const bool method = action.menu == "Method" && action.name.starts_with("method ");
    KeyRow row{"", (method ? "Method " : "") + action.title, "", action.tooltip};
    for (const Shortcut& shortcut : action.shortcuts)
      row.keys += (row.keys.empty() ? "" : " or ") + shortcut.label;
    if (action.checked) {
      row.on = action.checked(state);
      row.value = row.on ? "on" : "off";
    }
    if (action.value) row.value = action.value(state);
    rows.push_back(std::move(row));
  }
  constexpr const char* kMouse[][2] = {
      {"Wheel", "Zoom image, scene, normals, time line"},
      {"Drag", "Move the image, orbit the scene"},
      {"Shift+Drag", "Select tracks in the image, move the scene"},
      {"Double click", "Fit image or scene"},
      {"Click", "Select a track, go to a camera, start where a scan succeeded"},
      {"Ctrl+Click", "Add a track to the selection, or remove it"},
      {"Right click", "Move the cube here, reset a setting, copy a table"},
      {"Drop a file", "Open a recording, a session or a results.csv"}};
  for (const auto& [keys, title] : kMouse) rows.push_back({keys, title, "", ""});
  return rows;
}

void draw_key(const KeyRow& row, float /*scale*/) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.keys);
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(row.title.c_str());
  tooltip(row.tooltip);
  ImGui::TableNextColumn();
  colored_text(row.on ? Role::good : Role::text_dim, row.value);
}

void draw_term(const GlossaryTerm& row, float scale) {
  ImGui::TableNextColumn();
  colored_text(Role::accent, row.term);
  ImGui::TableNextColumn();
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + 420 * scale);
  ImGui::TextUnformatted(row.meaning);
  ImGui::PopTextWrapPos();
}

/// Draws the rows in two tables side by side.
template <class Row>
void draw_halves(std::span<const Row> rows, int columns, void (*draw)(const Row&, float), float s) {
  const auto flags = ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_NoHostExtendX;
  const std::size_t half = (rows.size() + 1) / 2;
  const auto table = [&](const char* id, std::span<const Row> part) {
    if (!ImGui::BeginTable(id, columns, flags)) return;
    for (const Row& row : part) {
      ImGui::TableNextRow();
      draw(row, s);
    }
    ImGui::EndTable();
  };
  table("left", rows.first(half));
  ImGui::SameLine(0, 24 * s);
  table("right", rows.subspan(half));
}

/// Dims all panels below the overlay, which a click on them closes.
void dim_window(const Rectangle& window, Commands& commands) {
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowPos({window.x, window.y});
  ImGui::SetNextWindowSize({window.width, window.height});
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::background, 0.6));
  ImGui::Begin(
      "dim",
      nullptr,
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::IsWindowHovered() && ImGui::IsMouseClicked(0)) push(commands, RunAction{"escape"});
  ImGui::End();
  ImGui::PopStyleColor();
}

void draw_title(const PanelContext& ui) {
  bool& glossary = ui.views.glossary;
  ImGui::PushFont(font(Font::heading));
  ImGui::TextUnformatted(glossary ? "Glossary" : "Keys");
  ImGui::PopFont();
  ImGui::SameLine(0, 16 * ui.scale);
  if (ImGui::SmallButton(glossary ? "Keys" : "Glossary")) glossary = !glossary;
  tooltip(glossary ? "Lists the keys" : "Explains the terms that the window uses");
  ImGui::SameLine(0, 8 * ui.scale);
  if (ImGui::SmallButton("Find a command (Ctrl+P)")) {
    push(ui.commands, RunAction{"escape"});
    push(ui.commands, RunAction{"palette"});
  }
}

// Rows of ui/GLOSSARY.md; a test compares them.
constexpr GlossaryTerm kGlossary[] = {
    {"window", "The consecutive frames that are initialized together; the time line marks them."},
    {"reference frame",
     "The first frame of the window; its camera is the origin of plane, poses and points."},
    {"track", "An image point that is followed from frame to frame."},
    {"anchored tracking",
     "Each frame is aligned with the patch of the reference frame instead of the previous frame, "
     "so that tracks do not drift."},
    {"parallax", "Image motion that a rotation of the camera does not explain."},
    {"homography", "The mapping that takes the points of a plane from one image to another."},
    {"inlier", "A track that agrees with the homographies of its plane to within the threshold."},
    {"outlier", "A track that does not lie on the plane, or was tracked wrongly."},
    {"transfer error",
     "The distance [px] between a track and the position that the frame's homography predicts."},
    {"residual",
     "The distance [px] between a track and the position that the estimated plane and poses "
     "predict."},
    {"RMS", "The root mean square of the residuals of all inliers [px]."},
    {"decomposition",
     "One solution for rotation, translation and plane normal that explains a homography; a "
     "homography has several."},
    {"chirality",
     "The condition that points lie in front of every camera; decompositions that violate it are "
     "rejected."},
    {"leading plane",
     "The plane that cube, normal and errors refer to if the window has several planes."},
    {"distance d",
     "The distance of the reference camera from the leading plane; the unit of length without "
     "metric scale."},
    {"baseline |t| [d]",
     "The distance between a camera and the reference camera, in plane distances d."},
    {"verdict",
     "Whether the window determines plane and poses: ready, weak, degenerate or no plane."},
    {"ready", "The verdict on a window that determines the plane normal well."},
    {"weak", "The verdict on a window whose result is uncertain; a longer camera path helps."},
    {"degenerate",
     "The verdict on a window that does not determine the plane, usually for lack of parallax."},
    {"ambiguous", "Two plane orientations fit the window equally well."},
    {"normal uncertainty",
     "The standard deviation (1 sigma) of the angle of the plane normal, estimated without ground "
     "truth."},
    {"Cram\u00e9r-Rao bound",
     "The smallest normal uncertainty that an unbiased method can reach with the same tracks."},
    {"PNE",
     "The plane normal error: the angle between the estimated and the true plane normal [deg]."},
    {"PDE",
     "The plane distance error: the error of the distance between reference camera and plane."},
    {"ATE",
     "The absolute trajectory error: the RMS distance between the aligned and the true camera "
     "centers."},
    {"metric scale",
     "The number of meters in a plane distance d, estimated from the accelerometer."},
    {"row delay", "The time between two successive image rows of a rolling shutter."},
    {"readout", "The time that a rolling shutter takes to read all rows of an image."},
    {"cube anchor", "The point of the plane on which the virtual cube stands."}};

}  // namespace

std::span<const GlossaryTerm> glossary() { return kGlossary; }

void help_overlay(const PanelContext& ui, const Rectangle& window) {
  const float s = ui.scale;
  dim_window(window, ui.commands);
  ImGui::SetNextWindowFocus();
  ImGui::SetNextWindowPos(
      {window.x + window.width / 2, window.y + window.height / 2}, 0, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {window.width - 8 * s, window.height - 8 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {20 * s, 16 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_CellPadding, {8 * s, 3 * s});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 6 * s);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, imgui_color(Role::raised));
  ImGui::Begin("keys",
               nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  draw_title(ui);
  if (ui.views.glossary) {
    ImGui::PushID("glossary");
    draw_halves<GlossaryTerm>(glossary(), 2, draw_term, s);
    ImGui::PopID();
  } else {
    draw_halves<KeyRow>(key_rows(ui.state), 3, draw_key, s);
  }
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
}

}  // namespace gpo
