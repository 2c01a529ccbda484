// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/panels/panels.h"

#include <algorithm>

#include <fmt/format.h>

namespace gpo {
namespace {

/// Draws the scene of one of two plane orientations, with a button that takes it.
void draw_orientation(const PanelContext& ui,
                      const Rectangle& place,
                      std::size_t number,
                      const Compared& one) {
  const float s = ui.scale;
  const std::string key = setting_text(one.settings, "rotations");
  const bool shown = one.inspection && one.inspection->initialization->ok;
  std::string text = fmt::format("Orientation {}", number + 1);
  if (shown && one.inspection->initialization->verdict)
    text += ": " + verdict_text(*one.inspection->initialization->verdict);
  else if (one.inspection)
    text += ": " + one.inspection->initialization->reason;
  else
    text += one.error.empty() ? ": computing" : ": " + one.error;
  ImGui::SetCursorScreenPos({place.x + 10 * s, place.y + 8 * s});
  ImGui::BeginGroup();
  wrapped_text(text, ImGui::GetCursorPosX() + place.width - 20 * s);
  ImGui::PushID(key.c_str());
  if (shown && ImGui::SmallButton("Take this one"))
    push(ui.commands, RunAction{"set rotations " + key});
  ImGui::PopID();
  tooltip("Sets the source of rotations to " + key + ". Ctrl+Z to undo");
  ImGui::EndGroup();
  if (!shown) return;
  const float top = ImGui::GetItemRectMax().y - place.y;
  const Rectangle below{place.x, place.y + top, place.width, std::max(1.0F, place.height - top)};
  const Inspection& inspection = *one.inspection;
  const double side = cube_side(inspection, ui.state.document.cube_side);
  const OrbitCamera camera = scene_camera(
      inspection, side, below.width / below.height, ui.state.view.viewpoint, ui.state.view.frame);
  ViewOptions options = view_options(ui, ui.views);
  options.show.legend = false;
  options.colors = nullptr;
  const FrameView view{inspection, ui.state.view.frame, options};
  auto& scene = ui.views.orientations[number];
  if (!scene) scene = std::make_unique<SceneView>();
  draw_scene_view({*ImGui::GetWindowDrawList(), screen_rect(below)}, view, *scene, camera);
}

}  // namespace

void orientations_panel(const PanelContext& ui, const Rectangle& place) {
  const std::vector<Compared> results = orientation_results(ui.state);
  const bool stacked = place.height > 1.2F * place.width;
  Rectangle part = place;
  (stacked ? part.height : part.width) =
      std::max(1.0F, std::floor((stacked ? place.height : place.width) / 2));
  for (std::size_t i = 0; i < results.size(); ++i) {
    draw_orientation(ui, part, i, results[i]);
    (stacked ? part.y : part.x) += stacked ? part.height : part.width;
  }
}

}  // namespace gpo
