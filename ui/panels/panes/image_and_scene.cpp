// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// The image and the scene with their overlays.
#include "engine/inspection/studies/studies.h"
#include "ui/panels/panels.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

/// Returns the state with another result in place of the current one; null until computed.
WorkbenchState showing(const WorkbenchState& state, const Compared& other) {
  WorkbenchState shown = state;
  shown.results.inspection = other.inspection;
  return shown;
}

/// Returns the state with the frames after the window in the window, if the current one is there.
std::optional<WorkbenchState> showing_after(const WorkbenchState& state) {
  const auto& extended = state.results.extended;
  if (!extended || !state.results.inspection) return std::nullopt;
  const int frame = state.view.frame - extended->window->start;
  if (frame < *extended->extrapolated_from || frame >= extended->window->frame_count())
    return std::nullopt;
  WorkbenchState shown = state;
  shown.results.inspection = extended;
  return shown;
}

/// Names the result that the image shows in place of the current one, in its upper right corner.
void draw_flip_label(const Area& area, const Compared& other) {
  auto& [list, rect] = area;
  const float s = overlay_scale();
  std::string text = title_of(other.configuration);
  if (!other.inspection)
    text += other.error.empty() ? ": computing" : ": not computed, " + other.error;
  const ImFont* bold = font(Font::bold);
  const ImVec2 size = bold->CalcTextSizeA(bold->FontSize, 1e6F, 0, text.c_str());
  const float width = size.x + 34 * s, height = size.y + 12 * s;
  const ImVec2 corner = to_imgui(rect.min + Vector2d(rect.size.x(), 0));
  const ImVec2 at(std::round(corner.x - width - 10 * s), std::round(corner.y + 10 * s));
  const ImVec2 end(at.x + width, at.y + height);
  const std::uint32_t rgb = color_of(other.configuration);
  list.AddRectFilled(at, end, imgui_color(Role::background, 0.88), 5 * s);
  list.AddRect(at, end, imgui_color(rgb), 5 * s, 0, 1.5F * s);
  list.AddRectFilled(
      at, {at.x + 8 * s, end.y}, imgui_color(rgb), 5 * s, ImDrawFlags_RoundCornersLeft);
  write_text(list, Font::bold, {at.x + 20 * s, at.y + 6 * s}, text);
}

bool has_room_for_legend(const Rectangle& place, float scale) {
  return place.width >= 300 * scale && place.height >= 240 * scale;
}

std::string frame_text(const TrackLife& life, int frame) {
  const auto found = std::ranges::find(life.frames, frame, &TrackFrame::frame);
  if (found == life.frames.end()) return fmt::format("not seen in frame {}\n", frame);
  std::string text = fmt::format("at ({:.2f}, {:.2f}) px\n", found->raw_px.x(), found->raw_px.y());
  if (const std::string decision = decision_text(*found); !decision.empty())
    text += decision + "\n";
  return text;
}

void track_tooltip(const PanelContext& ui, std::int64_t track) {
  const Inspection* inspection = ui.inspection();
  const auto column = inspection ? column_of(*inspection->tracks, track) : std::nullopt;
  if (!column) return;
  const TrackLife& life = ui.views.lives.of(*inspection, *column);
  std::string text = fmt::format("track {}\n", track) + frame_text(life, ui.state.view.frame);
  const auto meters = known_scale(*inspection);
  if (life.depth)
    text += "depth " +
            (meters ? length_text(*meters * *life.depth) : fmt::format("{:.3f} d", *life.depth)) +
            "\n";
  if (life.inlier_since && life.inlier_until)
    text += fmt::format("inlier from frame {} to {}\n", *life.inlier_since, *life.inlier_until);
  text += life.verdict;
  if (const auto plane = to_main_plane(*inspection, track))
    text += fmt::format("\nmain-plane {} makes its plane the main one", *plane);
  show_tooltip(text);
}

/// Selects a track; with Ctrl adds or removes it.
void click_track(const PanelContext& ui, std::int64_t id) {
  const Selection& selection = ui.state.selection;
  const bool adds = ImGui::GetIO().KeyCtrl;
  push(ui.commands, SelectTracks{adds ? toggled(selection, id) : selected({&id, 1})});
}

struct Pointer {
  const PanelContext& ui;
  int frame;  ///< the one that is drawn
  ScreenRect rect;
  ImageMapping mapping;
  Vector2d at = mouse_px();
  Vector2d pressed_at = {ImGui::GetIO().MouseClickedPos[0].x, ImGui::GetIO().MouseClickedPos[0].y};

  /// Returns the id of the track under the mouse; nullopt if none is shown there.
  std::optional<std::int64_t> track() const {
    const WorkbenchState& state = ui.state;
    if (!state.results.inspection || !ImGui::IsItemHovered() || !state.view.toggles.tracks)
      return std::nullopt;
    const Inspection& inspection = *state.results.inspection;
    const auto column =
        track_at(inspection, frame - inspection.window->start, mapping, at, 10 * ui.scale);
    return column ? std::optional(inspection.tracks->ids[*column]) : std::nullopt;
  }
};

/// Returns the row of the image's legend under the mouse; nullopt if none is there.
std::optional<LegendHit> legend_under(const Pointer& pointer) {
  const auto& hits = pointer.ui.views.legend_hits;
  const auto found = std::ranges::find_if(hits, [&](const LegendHit& hit) {
    const Vector2d from_corner = pointer.at - hit.rect.min;
    return from_corner.minCoeff() >= 0 && (hit.rect.size - from_corner).minCoeff() >= 0;
  });
  return ImGui::IsItemHovered() && found != hits.end() ? std::optional(*found) : std::nullopt;
}

std::string legend_tooltip(const LegendHit& hit) {
  if (std::string_view(hit.action) == "legend")
    return "Hides the legends; View, Legends shows them again";
  return "Click to show or hide: " + action_named(hit.action).title;
}

void zoom_and_pan(const Pointer& pointer) {
  const bool drags_cube = takes_mask(pointer.ui.state, pointer.frame) ||
                          drag_cube(pointer.ui, pointer.frame, pointer.mapping);
  const WorkbenchState& state = pointer.ui.state;
  const ImageZoom& zoom = state.view.image_zoom;
  const ShownImage image = as_shown(*shown_recording(state));
  const auto change = [&](const ImageZoom& to) { push(pointer.ui.commands, ZoomImage{to}); };
  if (const double by = wheel_zoom(); by != 1)
    change(zoom_about(zoom, image, pointer.rect, pointer.at, by));
  const Vector2d drag = drag_px();
  if (is_item_double_clicked())
    change({});
  else if (!drag.isZero() && !ImGui::GetIO().KeyShift && !drags_cube)
    change(pan(zoom, image, pointer.rect, drag));
}

/// Returns the tracks inside the dragged rectangle of the screen, which may be undistorted.
std::vector<std::int64_t> tracks_in_rectangle(const Pointer& pointer) {
  const WorkbenchState& state = pointer.ui.state;
  const Eigen::AlignedBox2d box(pointer.at.cwiseMin(pointer.pressed_at),
                                pointer.at.cwiseMax(pointer.pressed_at));
  std::vector<std::int64_t> ids = tracks_in_view(state);
  std::erase_if(ids, [&](std::int64_t id) {
    const Tracks& tracks = *state.results.inspection->tracks;
    const Vector2d raw_px =
        tracks.raw_px[state.view.frame - tracks.start].col(*column_of(tracks, id));
    return !box.contains(to_screen(pointer.mapping, raw_px));
  });
  return ids;
}

/// A click selects a track, Ctrl+click adds or removes one, Shift+drag selects a rectangle.
void select(const Pointer& pointer, std::optional<std::int64_t> track) {
  const PanelContext& ui = pointer.ui;
  const ImGuiIO& io = ImGui::GetIO();
  const Selection& selection = ui.state.selection;
  if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return;
  const bool clicked = is_click(ui.scale);
  if (clicked && io.KeyAlt) {
    push(ui.commands, [raw_px = to_image(pointer.mapping, pointer.at)](WorkbenchState& state) {
      pick_point(state, raw_px);
    });
  } else if (clicked && track) {
    click_track(ui, *track);
  } else if (clicked && !io.KeyCtrl && !selection.tracks.empty()) {
    push(ui.commands, SelectTracks{});
  } else if (!clicked && io.KeyShift) {
    const std::vector<std::int64_t> within = tracks_in_rectangle(pointer);
    push(ui.commands, SelectTracks{io.KeyCtrl ? extended(selection, within) : selected(within)});
  }
}

void draw_rectangle(const Pointer& pointer, ImDrawList& list) {
  if (!ImGui::IsItemActive() || !ImGui::GetIO().KeyShift) return;
  const ImVec2 a = to_imgui(pointer.pressed_at), b = to_imgui(pointer.at);
  list.AddRectFilled(a, b, imgui_color(Role::accent, 0.15));
  list.AddRect(a, b, imgui_color(Role::accent), 0, 0, 1.5F * pointer.ui.scale);
}

/// A right click opens the menu of the track and of the plane under the mouse.
void open_menu(const Pointer& pointer, std::optional<std::int64_t> track) {
  const Inspection* inspection = pointer.ui.inspection();
  if (!right_clicked(pointer.ui.scale) || !inspection || !inspection->initialization) return;
  std::vector<ContextSubject> subjects;
  if (track) subjects.push_back(track_subject(*inspection, *track));
  const int frame = pointer.frame - inspection->window->start;
  const Vector2d raw_px = to_image(pointer.mapping, pointer.at);
  if (inspection->initialization->ok && frame >= 0 && frame < inspection->window->frame_count()) {
    const int number = plane_near(*inspection, frame, raw_px).value_or(inspection->window->leader);
    const Plane* plane = estimated_plane(*inspection, number);
    subjects.push_back(plane_subject(
        *inspection,
        number,
        plane == nullptr ? std::nullopt : point_on_plane(*inspection, frame, raw_px, *plane)));
  }
  subjects.push_back(point_subject(raw_px));
  subjects.push_back({.kind = ContextKind::area, .title = "Masks of the reference frame"});
  open_context_menu(pointer.ui, std::move(subjects));
}

void draw_overlays(const Pointer& pointer, const Rectangle& place, ImDrawList& list) {
  const PanelContext& ui = pointer.ui;
  const WorkbenchState& state = ui.state;
  const Camera& camera = shown_recording(state)->camera;
  const Inspection* inspection = ui.inspection();
  const Inspection waiting = inspection ? Inspection{} : nothing_to_show(state.document.recording);
  ViewOptions options = view_options(ui, ui.views);
  options.show.legend &= has_room_for_legend(place, ui.scale);
  options.image_zoom = state.view.image_zoom;
  options.says_failure = !ui.banner;
  options.legend_line = true;
  const FrameView view{inspection ? *inspection : waiting, pointer.frame, options};
  const Area area{list, pointer.rect};
  ui.views.legend_hits = draw_image_view(area, view, shown_image(ui.views));
  if (inspection) draw_highlight_in_image(area, view, pointer.mapping, highlight_of(state));
  draw_pixel_grid(area, pointer.mapping);
  draw_rectangle(pointer, list);
  draw_picked_points(state, area, view, pointer.mapping);
  if (takes_mask(state, pointer.frame)) draw_unfinished_mask(ui, area, pointer.mapping);
  if (!ImGui::IsItemHovered()) return;
  const Vector2d at = to_image(pointer.mapping, pointer.at);
  const double scale = pointer.mapping.scale / ui.scale;
  draw_pixel_text(area,
                  pixel_text({inspection, pointer.frame, camera, ui.views.pixels, at, scale}));
}

void draw_panel(const PanelContext& ui, const Rectangle& place) {
  ImGui::SetNextWindowBgAlpha(0);  // the image covers it
  const PanelScope scope("picture", place, {0, 0});
  const WorkbenchState& state = ui.state;
  const int frame = update_image(ui);
  hit_area("view",
           {place.width, place.height},
           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle |
               ImGuiButtonFlags_MouseButtonRight);
  const ScreenRect rect = screen_rect(place);
  const ViewState& view = state.view;
  const ShownImage image = as_shown(*shown_recording(state));
  const Pointer pointer{
      ui, frame, rect, map_image(image, rect, view.image_zoom, view.toggles.undistorted)};
  zoom_and_pan(pointer);
  const std::optional<LegendHit> legend = legend_under(pointer);
  const auto track = legend ? std::nullopt : pointer.track();
  if (ImGui::IsItemHovered() && Hover{track} != state.hover) push(ui.commands, HoverOver{{track}});
  const bool masks = takes_mask(state, frame);
  if (masks)
    draw_mask_by_mouse(ui, pointer.mapping);
  else if (!legend)
    select(pointer, track);
  else if (ImGui::IsMouseReleased(ImGuiMouseButton_Left) && is_click(ui.scale))
    push(ui.commands, RunAction{legend->action});
  if (!masks) open_menu(pointer, track);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  draw_overlays(pointer, place, list);
  if (track) track_tooltip(ui, *track);
  if (legend) tooltip(legend_tooltip(*legend));
  if (!ui.views.image_error.empty())
    draw_badge({list, rect}, color_of(Role::bad), "no image", ui.views.image_error);
}

/// Returns what is under the mouse; a point has priority over a camera.
Hover hover_in(const PanelContext& ui, const ScreenRect& rect, const OrbitCamera& camera) {
  Hover hover;
  if (!ImGui::IsItemHovered()) return hover;
  const Inspection& inspection = *ui.inspection();
  const ScenePixel at{camera, rect.size, mouse_px() - rect.min};
  if (const auto column = point_at(inspection, at, 7 * ui.scale))
    hover.track = inspection.tracks->ids[*column];
  else if (const auto frame = camera_at(inspection, at, 9 * ui.scale))
    hover.camera = inspection.window->start + *frame;
  return hover;
}

/// A right click opens the menu of the point or camera and of the plane under the mouse.
void open_scene_menu(const PanelContext& ui, const Hover& hover, const ScenePixel& at) {
  if (!right_clicked(ui.scale)) return;
  const Inspection& inspection = *ui.inspection();
  std::vector<ContextSubject> subjects;
  if (hover.track) subjects.push_back(track_subject(inspection, *hover.track));
  if (hover.camera)
    subjects.push_back({.kind = ContextKind::frame,
                        .title = fmt::format("Frame {}", *hover.camera),
                        .frame = *hover.camera});
  if (const auto point = plane_at(inspection, at))
    subjects.push_back(plane_subject(inspection, point->plane, point->point));
  open_context_menu(ui, std::move(subjects));
}

void click(const PanelContext& ui, const Hover& hover) {
  if (!ImGui::IsItemDeactivated() || !ImGui::IsMouseReleased(ImGuiMouseButton_Left)) return;
  if (!is_click(ui.scale)) return;
  if (hover.track)
    click_track(ui, *hover.track);
  else if (hover.camera)
    push(ui.commands, GoToFrame{*hover.camera});
}

/// `frame` counts in the recording.
void camera_tooltip(const Inspection& inspection, int frame) {
  const int in_window = frame - inspection.window->start;
  const auto meters = known_scale(inspection);
  const Vector3d center = meters.value_or(1) * inspection.initialization->cameras[in_window].p_wc;
  show_tooltip(fmt::format("camera of frame {}\ncenter ({:.3f}) {}\n{}\nClick to go to the frame",
                           frame,
                           fmt::join(center, ", "),
                           meters ? "m" : "d",
                           counted(inspection.window->inlier_count(in_window), "inlier")));
}

}  // namespace

void image_panel(const PanelContext& ui, const Rectangle& place) {
  const auto other = flipped_result(ui.state);
  if (!other) {
    const auto after = showing_after(ui.state);
    return draw_panel(after ? PanelContext{ui.with(*after), ui.views, ui.commands, ui.banner} : ui,
                      place);
  }
  const WorkbenchState state = showing(ui.state, *other);
  draw_panel({ui.with(state), ui.views, ui.commands, ui.banner}, place);
  const PanelScope scope("picture", place, {0, 0});
  draw_flip_label({*ImGui::GetWindowDrawList(), screen_rect(place)}, *other);
}

/// The image without controls, for screenshots, snapshots and movies.
void image_alone(const PanelContext& ui, const Rectangle& place) {
  const Area area{*ImGui::GetBackgroundDrawList(), screen_rect(place)};
  const auto other = flipped_result(ui.state);
  const auto replaced = other ? std::optional(showing(ui.state, *other)) : showing_after(ui.state);
  const WorkbenchState& state = replaced ? *replaced : ui.state;
  const Inspection* inspection = state.results.inspection.get();
  const Inspection empty = inspection ? Inspection{} : nothing_to_show(ui.state.document.recording);
  const int frame = update_image(ui);
  const ViewOptions options = view_options(ui.with(state), ui.views);
  draw_image_view(area, {inspection ? *inspection : empty, frame, options}, shown_image(ui.views));
  if (other) draw_flip_label(area, *other);
}

void scene_pane(const PanelContext& ui, const Rectangle& place) {
  if (!ui.inspection()) return draw_empty(place, "The scene appears when the window is computed");
  const WorkbenchState& state = ui.state;
  const Inspection& inspection = *ui.inspection();
  hit_area("view",
           {place.width, place.height},
           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  const double side = cube_side(inspection, state.document.cube_side);
  const OrbitCamera camera = state.view.orbit.value_or(scene_camera(
      inspection, side, place.width / place.height, state.view.viewpoint, state.view.frame));
  const ScreenRect rect = screen_rect(place);
  orbit_and_zoom(ui, rect, camera);
  const Hover hover = hover_in(ui, rect, camera);
  if (ImGui::IsItemHovered() && hover != state.hover) push(ui.commands, HoverOver{hover});
  click(ui, hover);
  open_scene_menu(ui, hover, {camera, rect.size, mouse_px() - rect.min});
  ViewOptions options = view_options(ui, ui.views);
  options.show.legend &= has_room_for_legend(place, ui.scale);
  options.says_failure = !ui.banner;
  if (ui.hurries) options.detail = SceneDetail::live;
  if (ImGui::IsItemActive() && ImGui::IsMouseDragging(0, 0)) options.detail = SceneDetail::dragged;
  const Area area{*ImGui::GetWindowDrawList(), rect};
  const FrameView view{inspection, state.view.frame, options};
  draw_scene_view(area, view, ui.views.scene, camera);
  draw_highlight_in_scene(area, view, camera, highlight_of(state));
  if (hover.track) track_tooltip(ui, *hover.track);
  if (hover.camera) camera_tooltip(inspection, *hover.camera);
}

}  // namespace gpo
