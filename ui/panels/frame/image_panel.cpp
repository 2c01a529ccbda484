// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "ui/context/gui.h"
#include "ui/context/theme.h"
#include "ui/panels/panels.h"
#include "ui/panels/panes/view_options.h"
#include "ui/panels/track_tooltip.h"
#include "ui/panels/widgets.h"
#include "ui/views/overlay/overlay.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/image/image_view.h"
#include "ui/views/image/pixel_readout.h"
#include "ui/views/image/track_highlight.h"
#include "ui/workbench/compared.h"
#include "ui/workbench/state.h"

#include <cmath>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector2d;

/// The picture on the screen, and where the mouse is.
struct Pointer {
  const WorkbenchState& state;
  int frame;  ///< that is drawn
  ScreenRect rect;
  ImageMapping mapping;
  float scale;
  Vector2d at = {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y};
  Vector2d pressed_at = {ImGui::GetIO().MouseClickedPos[0].x, ImGui::GetIO().MouseClickedPos[0].y};

  /// Nothing while the mouse is elsewhere or nothing is shown there.
  std::optional<std::int64_t> track() const {
    if (!state.results.inspection || !ImGui::IsItemHovered() || !state.view.toggles.tracks)
      return std::nullopt;
    const Inspection& inspection = *state.results.inspection;
    const auto column =
        track_at(inspection, frame - inspection.window->start, mapping, at, 10 * scale);
    return column ? std::optional(inspection.tracks->ids[*column]) : std::nullopt;
  }
};

void zoom_and_pan(const Pointer& pointer, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImageZoom& zoom = pointer.state.view.image_zoom;
  const Camera& camera = pointer.state.document.recording->camera;
  if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
    const double by = std::pow(1.25, io.MouseWheel);
    push(commands, ZoomImage{zoom_about(zoom, camera, pointer.rect, pointer.at, by)});
  }
  const Vector2d by(io.MouseDelta.x, io.MouseDelta.y);
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    push(commands, ZoomImage{});
  } else if (ImGui::IsItemActive() && !io.KeyShift && !by.isZero()) {
    push(commands, ZoomImage{pan(zoom, camera, pointer.rect, by)});
  }
}

/// Between where the mouse was pressed and where it is, on the screen: without distortion that is
/// no rectangle of the picture.
std::vector<std::int64_t> tracks_in_rectangle(const Pointer& pointer) {
  const Eigen::AlignedBox2d box(pointer.at.cwiseMin(pointer.pressed_at),
                                pointer.at.cwiseMax(pointer.pressed_at));
  std::vector<std::int64_t> ids = tracks_in_view(pointer.state);
  std::erase_if(ids, [&](std::int64_t id) {
    const Tracks& tracks = *pointer.state.results.inspection->tracks;
    const Vector2d raw_px =
        tracks.raw_px[pointer.state.view.frame - tracks.start].col(*column_of(tracks, id));
    return !box.contains(to_screen(pointer.mapping, raw_px));
  });
  return ids;
}

/// Click: picks the track; with Ctrl beside the others. Shift and drag: those in a rectangle. Right
/// click: the cube comes here, where this is the reference frame.
void select(const Pointer& pointer, std::optional<std::int64_t> track, Commands& commands) {
  const ImGuiIO& io = ImGui::GetIO();
  const Selection& selection = pointer.state.selection;
  if (!ImGui::IsItemDeactivated()) return;
  const bool clicked = (pointer.at - pointer.pressed_at).norm() < 4 * pointer.scale;
  if (clicked && track) {
    push(commands, SelectTracks{io.KeyCtrl ? toggled(selection, *track) : selected({&*track, 1})});
    if (!io.KeyCtrl) lead_with(pointer.state, *track, commands);
  } else if (clicked && !io.KeyCtrl && !selection.tracks.empty()) {
    push(commands, SelectTracks{});
  } else if (!clicked && io.KeyShift) {
    const std::vector<std::int64_t> within = tracks_in_rectangle(pointer);
    push(commands, SelectTracks{io.KeyCtrl ? extended(selection, within) : selected(within)});
  }
}

void draw_rectangle(const Pointer& pointer, ImDrawList& list) {
  if (!ImGui::IsItemActive() || !ImGui::GetIO().KeyShift) return;
  const ImVec2 a = to_imgui(pointer.pressed_at), b = to_imgui(pointer.at);
  list.AddRectFilled(a, b, imgui_color(Role::accent, 0.15));
  list.AddRect(a, b, imgui_color(Role::accent), 0, 0, 1.5F * pointer.scale);
}

/// The ray of the reference camera through the mouse.
void move_cube(const Pointer& pointer, Commands& commands) {
  const WorkbenchState& state = pointer.state;
  const bool clicked = ImGui::IsItemHovered() && ImGui::IsMouseClicked(ImGuiMouseButton_Right);
  if (!clicked || !state.results.inspection || !state.results.inspection->initialization->ok)
    return;
  const Inspection& inspection = *state.results.inspection;
  const auto ray = point_on_plane(inspection,
                                  pointer.frame - inspection.window->start,
                                  to_image(pointer.mapping, pointer.at),
                                  inspection.initialization->plane);
  if (ray) push(commands, MoveCube{ray});
}

void draw_panel(const PanelInput& input, const Rectangle& place, Views& views, Commands& commands) {
  ImGui::SetNextWindowBgAlpha(0);  // all of it is drawn over
  const PanelScope panel("picture", place, {0, 0});
  const WorkbenchState& state = input.state;
  const int frame = update_image(input, views);
  hit_area("view",
           {place.width, place.height},
           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
               ImGuiButtonFlags_MouseButtonRight);
  const ScreenRect rect = screen_rect(place);
  const Camera& camera = state.document.recording->camera;
  const Pointer pointer{
      state,
      frame,
      rect,
      map_image(camera, rect, state.view.image_zoom, state.view.toggles.undistorted),
      input.scale};
  zoom_and_pan(pointer, commands);
  const auto track = pointer.track();
  if (ImGui::IsItemHovered() && Hover{track} != state.hover) push(commands, HoverOver{{track}});
  select(pointer, track, commands);
  move_cube(pointer, commands);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const Inspection waiting =
      input.inspection() ? Inspection{} : nothing_to_show(state.document.recording);
  ViewOptions options = view_options(state, views);
  options.show.legend &= room_for_legend(place, input.scale);
  draw_image_view(list,
                  rect,
                  input.inspection() ? *input.inspection() : waiting,
                  frame,
                  shown_image(views),
                  state.view.image_zoom,
                  options);
  if (input.inspection()) {
    const Inspection& inspection = *input.inspection();
    draw_highlight_in_image(list,
                              rect,
                              inspection,
                              frame - inspection.window->start,
                              pointer.mapping,
                              highlight_of(state));
  }
  draw_pixel_grid(list, rect, pointer.mapping, camera);
  draw_rectangle(pointer, list);
  if (ImGui::IsItemHovered())
    draw_pixel_text(list,
                    rect,
                    pixel_text(input.inspection(),
                               frame,
                               camera,
                               views.pixels,
                               to_image(pointer.mapping, pointer.at),
                               pointer.mapping.scale / input.scale));
  if (track) track_tooltip(input, views, *track);
  if (!views.image_error.empty()) {
    draw_badge(list, rect, color_of(Role::bad), "no picture", views.image_error);
  }
}

}  // namespace

void image_panel(const PanelInput& own, const Rectangle& place, Views& views, Commands& commands) {
  const auto other = flipped_result(own.state);
  if (!other) return draw_panel(own, place, views, commands);
  const WorkbenchState state = showing(own.state, *other);
  draw_panel(
      {state, own.worker, own.survey, own.timings, own.scale, own.writing, own.scan, own.fetcher},
      place,
      views,
      commands);
  const PanelScope panel("picture", place, {0, 0});
  draw_flip_label(*ImGui::GetWindowDrawList(), screen_rect(place), *other);
}

}  // namespace gpo
