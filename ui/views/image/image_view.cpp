// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_view.h"

#include "engine/base/error.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"
#include "engine/window/tracks.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr int kTailFrames = 10;
constexpr double kResidualMagnification = 20;

struct Canvas : ImageCanvas {
  const FrameView& view;
  const ImageTexture* image;  ///< null: none
  const Inspection& inspection = view.inspection;
  int frame = view.in_window();
  const ViewOptions& options = view.options;

  SignStyle look(int track) const {
    SignStyle look = track_style(inspection, frame, track);
    if (options.colors) look.rgb = options.colors->rgb(track);
    return look;
  }
  const Pose& pose() const { return inspection.initialization->cameras[frame]; }
  RollingCamera rolling() const { return rolling_camera(inspection, frame); }
  CubeSize cube_size() const {
    return {cube_side(inspection, options.cube_side), options.cube_height_sides};
  }
};

void draw_tails(const Canvas& canvas) {
  const Tracks& tracks = *canvas.inspection.tracks;
  const int oldest = std::max(0, canvas.frame - kTailFrames);
  for (int track = 0; track < tracks.track_count(); ++track) {
    if (!tracks.seen(canvas.frame, track)) continue;
    const std::uint32_t rgb = canvas.look(track).rgb;
    for (int i = oldest; i < canvas.frame; ++i) {
      const double age = static_cast<double>(canvas.frame - i) / kTailFrames;
      const ImVec2 from = canvas.at(tracks.raw_px[i].col(track));
      const ImVec2 to = canvas.at(tracks.raw_px[i + 1].col(track));
      const ImU32 color = imgui_color(rgb, 0.15 + 0.6 * (1 - age));
      canvas.list.AddLine(from, to, color, 1.4F * overlay_scale());
    }
  }
}

template <class Chosen>
void draw_tracks(const Canvas& canvas, const Chosen& chosen) {
  const Tracks& tracks = *canvas.inspection.tracks;
  for (const bool seen : {false, true})  // signs of the lost ones are below
    for (int track = 0; track < tracks.track_count(); ++track) {
      if (tracks.seen(canvas.frame, track) != seen || !chosen(track)) continue;
      const auto place = place_of_sign(canvas.inspection, canvas.frame, track);
      if (!place) continue;
      const auto [sign, rgb] = canvas.look(track);
      draw_sign(canvas.list, sign, canvas.at(*place), rgb);
    }
}

void draw_residuals(const Canvas& canvas) {
  for (const ResidualVector& residual : residual_vectors(canvas.inspection, canvas.frame)) {
    const Vector2d tip = residual.observed_px +
                         kResidualMagnification * (residual.predicted_px - residual.observed_px);
    const ImVec2 from = canvas.at(residual.observed_px), to = canvas.at(tip);
    canvas.list.AddLine(from, to, imgui_color(Role::background, 0.5), 3.4F * overlay_scale());
    canvas.list.AddLine(from, to, imgui_color(Role::residual), 1.6F * overlay_scale());
  }
}

/// Returns the cube from which the estimated cube's distance is exaggerated; nullopt if it is not.
std::optional<CubeImage> exaggeration_reference(const Canvas& canvas) {
  const ViewOptions& options = canvas.options;
  if (options.show.exaggeration <= 1) return std::nullopt;
  if (auto truth = true_cube(canvas.inspection, canvas.frame, canvas.cube_size())) return truth;
  if (options.reference == nullptr) return std::nullopt;
  const double side = cube_side(*options.reference, options.reference_side);
  return estimated_cube(*options.reference, canvas.frame, {side, options.cube_height_sides});
}

/// Draws the image and its tracks again over the parts of the cube that nearer planes hide.
void draw_occluders(const Canvas& canvas, const CubeImage& cube, const CubeAnchor& anchor) {
  if (canvas.image == nullptr || canvas.image->id() == nullptr) return;
  const auto [side, height_sides] = canvas.cube_size();
  const auto corners_w = cube_corners(anchor, side, height_sides);
  const Eigen::AlignedBox2d box = bounds(canvas, cube);
  for (const Occluder& occluder :
       occluders(canvas.inspection, canvas.frame, corners_w, anchor.plane)) {
    canvas.list.PushClipRect(to_imgui(box.min()), to_imgui(box.max()), true);
    for (const Triangle& triangle : occluder.triangles_raw_px)
      draw_part(canvas, *canvas.image, triangle);
    canvas.list.PopClipRect();
    if (canvas.options.show.tracks)
      draw_tracks(canvas, [&](int track) {
        return plane_of_track(*canvas.inspection.window, canvas.frame, track) == occluder.plane;
      });
  }
}

void draw_standing(const Canvas& canvas, const CubeImage& cube, const CubeAnchor& anchor) {
  const double side = canvas.cube_size().side;
  const SolidModel* model = canvas.options.model.get();
  draw_body(canvas,
            {.cube = cube,
             .rings = contact_shadow(canvas.inspection, canvas.frame, anchor, side),
             .edges = cube_color(anchor, *canvas.inspection.window),
             .faces = cube_face_color(anchor, *canvas.inspection.window)},
            model != nullptr);
  if (model != nullptr) {
    const auto corners = cube_corners(anchor, side);
    draw_model(canvas, canvas.rolling(), canvas.pose(), *model, placed_on(*model, corners));
  }
  draw_occluders(canvas, cube, anchor);
}

void draw_cube(const Canvas& canvas, const CubeAnchor& anchor) {
  const ViewOptions& options = canvas.options;
  const bool main = !anchor.plane;
  CubeImage cube = cube_on(canvas.inspection, canvas.frame, anchor, canvas.cube_size());
  const auto reference = main ? exaggeration_reference(canvas) : std::nullopt;
  if (reference) cube = exaggerated(cube, *reference, options.show.exaggeration);
  // A body would hide its reference.
  const bool body = !options.show.wireframe && !reference;
  if (body) draw_standing(canvas, cube, anchor);
  if (main && options.show.truth)
    if (const auto truth = true_cube(canvas.inspection, canvas.frame, canvas.cube_size()))
      draw_dashed_cube(canvas, *truth, color_of(Role::truth));
  if (!body) draw_wireframe(canvas, cube, cube_color(anchor, *canvas.inspection.window));
}

/// Returns the solutions of a failure between which the tracks do not decide.
std::span<const RefusedSolution> undecided(const Inspection& inspection) {
  const Initialization& failure = *inspection.initialization;
  if (failure.ok || !failure.ambiguity) return {};
  return failure.ambiguity->undecided;
}

/// Draws the cubes on both planes of an ambiguous window, at the same place of the reference image.
void draw_undecided_cubes(const Canvas& canvas) {
  bool dashed = false;
  for (const RefusedSolution& one : undecided(canvas.inspection)) {
    const auto anchor =
        place_cube(one.plane, Pose{}, *canvas.inspection.recording, *canvas.inspection.window, {});
    if (!anchor) continue;
    const auto [chosen, height_sides] = canvas.cube_size();
    const double side = chosen > 0 ? chosen : default_cube_side(*anchor);
    const auto corners = cube_corners(*anchor, side, height_sides);
    const CubeImage cube = cube_in_image(canvas.rolling(), one.cameras[canvas.frame], corners);
    if (dashed)
      draw_dashed_cube(canvas, cube, color_of(Role::warning));
    else
      draw_wireframe(canvas, cube, color_of(Role::bad));
    dashed = true;
  }
}

void draw_cubes(const Canvas& canvas) {
  if (!canvas.inspection.initialization->ok) return draw_undecided_cubes(canvas);
  for (const CubeAnchor& anchor : cubes_far_to_near(canvas.inspection, canvas.frame))
    draw_cube(canvas, anchor);
}

/// Returns the horizon from the frame's estimated pose; empty if gravity is unknown or off.
Outlines horizon(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  if (!inspection.inertial || !inspection.inertial->ok || !canvas.options.show.gravity) return {};
  return horizon_in_image(canvas.rolling(), canvas.pose(), -inspection.inertial->gravity_m_s2);
}

/// Returns whether to show the principal point, because a finding doubts it.
bool doubts_principal_point(const Inspection& inspection) {
  const Finding* finding = find_finding(inspection.findings, "implausible-intrinsics");
  return finding != nullptr && !finding->ignored;
}

/// Draws the principal point as a large cross, and a line to the image center.
void draw_principal_point(const Canvas& canvas) {
  const Camera& camera = canvas.camera;
  const float s = overlay_scale(), arm = 9 * s;
  const ImVec2 p = canvas.at({camera.cx, camera.cy});
  const ImVec2 center = canvas.at({0.5 * (camera.width - 1), 0.5 * (camera.height - 1)});
  for (const auto& [color, width] : {std::pair{imgui_color(Role::background, 0.6), 3.0F * s},
                                     {imgui_color(Role::warning), 0.0F}}) {
    canvas.list.AddLine(p, center, color, 1.4F * s + width);
    canvas.list.AddLine({p.x - arm, p.y - arm}, {p.x + arm, p.y + arm}, color, 2.4F * s + width);
    canvas.list.AddLine({p.x - arm, p.y + arm}, {p.x + arm, p.y - arm}, color, 2.4F * s + width);
  }
  draw_sign(canvas.list, Sign::disc, center, color_of(Role::text));
}

LegendRows track_rows(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  const Window& window = *inspection.window;
  std::map<int, int> on_plane = {{window.leader, 0}};
  int outliers = 0, excluded = 0, fixed = 0;
  for (int track = 0; track < inspection.tracks->track_count(); ++track) {
    if (!inspection.tracks->seen(canvas.frame, track)) continue;
    const auto plane = plane_of_track(window, canvas.frame, track);
    ++(plane                            ? on_plane[*plane]
       : is_excluded(inspection, track) ? excluded
       : is_static(inspection, track)   ? fixed
                                        : outliers);
  }
  LegendRows rows = {
      {Sign::circle, plane_color(window.leader), counted(on_plane[window.leader], "inlier")}};
  for (const auto& [plane, count] : on_plane)
    if (plane != window.leader)
      rows.push_back({Sign::thin_circle,
                      plane_color(plane),
                      fmt::format("{} on {}", count, plane_title(inspection, plane))});
  rows.push_back({Sign::cross, color_of(Role::outlier), counted(outliers, "outlier")});
  if (fixed > 0)
    rows.push_back({Sign::square, color_of(Role::text_dim), fmt::format("{} do not move", fixed)});
  // In all frames if in the last one, so that the legend keeps its place.
  if (lost_count(window, window.frame_count() - 1) > 0)
    rows.push_back({Sign::diamond,
                    color_of(Role::lost),
                    fmt::format("{} lost", lost_count(window, canvas.frame))});
  if (excluded > 0)
    rows.push_back({Sign::dot, color_of(Role::text_dim), fmt::format("{} excluded", excluded)});
  return rows;
}

LegendRows legend_rows(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  const ViewOptions& options = canvas.options;
  LegendRows rows;
  const auto hidden = [&](const char* toggle, const char* text) {
    if (options.legend_line)
      rows.push_back({Sign::none, color_of(Role::text_dim), text, toggle, true});
  };
  if (options.show.tracks)
    rows = options.colors ? legend_rows(*options.colors) : track_rows(canvas);
  for (LegendRow& row : rows) row.toggle = "tracks";
  if (doubts_principal_point(inspection))  // first: a narrow image cuts off the last ones
    rows.insert(rows.begin(),
                {{Sign::cross, color_of(Role::warning), "principal point"},
                 {Sign::disc, color_of(Role::text), "image center"}});
  for (const auto& [kind, text] : {std::pair{MaskKind::leave_out, "mask: tracks left out"},
                                   {MaskKind::plane, "mask: plane 1 only here"}})
    if (canvas.frame == 0 && inspection.settings.mask.has(kind))
      rows.push_back({Sign::square, mask_color(kind), text});
  if (!options.show.tracks) hidden("tracks", "tracks");
  const auto add = [&rows](Sign sign, Role role, const std::string& text, const char* toggle = "") {
    rows.push_back({sign, color_of(role), text, toggle});
  };
  const bool ok = inspection.initialization->ok;
  if (ok && options.show.residuals)
    add(Sign::line,
        Role::residual,
        fmt::format("residuals × {:g}", kResidualMagnification),
        "residuals");
  if (ok && !options.show.residuals) hidden("residuals", "residuals");
  if (!horizon(canvas).empty()) add(Sign::line, Role::gravity, "horizon", "gravity");
  if (!options.show.cube && inspection.cube) hidden("cube", "cube");
  if (!options.show.cube) return rows;
  if (!undecided(inspection).empty()) {
    add(Sign::square, Role::bad, "cube on one plane that fits, solid", "cube");
    add(Sign::square, Role::warning, "cube on the other plane, dashed", "cube");
  }
  const bool truth = true_cube(inspection, canvas.frame, canvas.cube_size()).has_value();
  if (inspection.cube)
    rows.push_back({Sign::square,
                    cube_color({}, *inspection.window),
                    options.model ? "model on the estimated plane" : "cube on the estimated plane",
                    "cube"});
  if (!options.model_error.empty()) add(Sign::none, Role::warning, options.model_error);
  if (options.show.truth && truth) add(Sign::square, Role::truth, "true cube, dashed", "truth");
  if (!options.show.truth && truth) hidden("truth", "true cube");
  if (inspection.cube && exaggeration_reference(canvas))
    add(Sign::none,
        Role::warning,
        fmt::format(
            "distance from the {} cube × {}", truth ? "true" : "first", options.show.exaggeration));
  return rows;
}

void draw_results(const Canvas& canvas) {
  const ViewToggles& show = canvas.options.show;
  if (canvas.frame == 0)
    for (const Mask& mask : canvas.inspection.settings.mask.areas) draw_mask(canvas, mask);
  if (show.tracks && show.tails) draw_tails(canvas);
  if (show.tracks) draw_tracks(canvas, [](int) { return true; });
  if (show.residuals) draw_residuals(canvas);
  for (const Outline& piece : horizon(canvas)) {
    canvas.polyline(piece, imgui_color(Role::background, 0.5), 3.4F);
    canvas.polyline(piece, imgui_color(Role::gravity), 1.4F);
  }
  if (doubts_principal_point(canvas.inspection)) draw_principal_point(canvas);
  if (!show.cube) return;
  // The image ends at its border, and so does the cube. An undistorted image has no straight
  // border.
  const bool straight = canvas.mapping.undistorted == nullptr;
  if (straight)
    canvas.list.PushClipRect(to_imgui(canvas.mapping.origin), to_imgui(canvas.mapping.end()), true);
  draw_cubes(canvas);
  if (straight) canvas.list.PopClipRect();
}

/// Returns whether the frame's camera was located after the window.
bool is_extrapolated(const FrameView& view) {
  const auto& from = view.inspection.extrapolated_from;
  return from && view.in_window() >= *from && view.inside();
}

LegendRow extrapolation_row(const FrameView& view) {
  const int after = view.in_window() - *view.inspection.extrapolated_from + 1;
  return {Sign::frustum,
          color_of(Role::uncertain),
          fmt::format("extrapolated by PnP, {} after the window", counted(after, "frame"))};
}

/// Frames the image of an extrapolated camera in dashes.
void draw_extrapolated_frame(const Canvas& canvas) {
  const float s = overlay_scale();
  const Vector2d from = canvas.mapping.origin + Vector2d::Constant(2 * s);
  const Vector2d size = canvas.mapping.end() - Vector2d::Constant(2 * s) - from;
  const std::array<Vector2d, 5> outline = {
      from, from + Vector2d(size.x(), 0), from + size, from + Vector2d(0, size.y()), from};
  const std::array pattern = {12.0 * s, 8.0 * s};
  for (const auto& [start, end] : dashes_along(outline, pattern))
    canvas.list.AddLine(to_imgui(start), to_imgui(end), imgui_color(Role::uncertain), 3 * s);
}

/// Returns the share of a box that a rectangle covers.
double covered_share(const ScreenRect& rect, const Eigen::AlignedBox2d& box) {
  const auto both = box.intersection({rect.min, rect.min + rect.size});
  return both.isEmpty() || box.volume() <= 0 ? 0 : both.volume() / box.volume();
}

/// Returns the boxes of the cubes in all frames of the window.
std::vector<Eigen::AlignedBox2d> cube_boxes(const Canvas& canvas) {
  const Inspection& inspection = canvas.inspection;
  std::vector<Eigen::AlignedBox2d> boxes;
  if (!canvas.options.show.cube || !inspection.initialization->ok) return boxes;
  const int frames = std::min(inspection.window->frame_count(), inspection.tracks->frame_count());
  for (int i = 0; i < frames; ++i)
    for (const CubeAnchor& anchor : cubes_far_to_near(inspection, i))
      boxes.push_back(bounds(canvas, cube_on(inspection, i, anchor, canvas.cube_size())));
  return boxes;
}

/// Returns the number of tracks that a rectangle covers in all frames of the window.
double covered_tracks(const ScreenRect& rect, const Canvas& canvas) {
  const Tracks& tracks = *canvas.inspection.tracks;
  if (!canvas.options.show.tracks) return 0;
  const Eigen::AlignedBox2d box(rect.min, rect.min + rect.size);
  int covered = 0;
  for (int i = 0; i < std::min(canvas.inspection.window->frame_count(), tracks.frame_count()); ++i)
    for (int track = 0; track < tracks.track_count(); ++track)
      covered += tracks.seen(i, track) &&
                 box.contains(to_screen(canvas.mapping, tracks.raw_px[i].col(track)));
  return covered;
}

/// Returns the corner in which a legend covers least, where each cube counts as many tracks. It is
/// the same for all frames of the window, so that it stays in its place in a movie.
Corner legend_corner(const Canvas& canvas, const std::string& title, const LegendRows& rows) {
  constexpr double kTracksPerCube = 40;
  constexpr std::array kCorners = {
      Corner::top_left, Corner::top_right, Corner::bottom_left, Corner::bottom_right};
  const std::vector<Eigen::AlignedBox2d> cubes = cube_boxes(canvas);
  // Below is the badge of a failure.
  const std::size_t candidates = canvas.inspection.initialization->ok ? kCorners.size() : 2;
  return *std::ranges::min_element(std::span(kCorners).first(candidates), {}, [&](Corner corner) {
    const ScreenRect rect = legend_place(canvas.rect, corner, title, rows);
    double covered = covered_tracks(rect, canvas);
    for (const auto& cube : cubes) covered += kTracksPerCube * covered_share(rect, cube);
    return covered;
  });
}

std::string heading(const FrameView& view) {
  const auto& times = view.inspection.recording->timestamps_ns;
  const double seconds = static_cast<double>(times[view.frame] - times.front()) * 1e-9;
  const std::string& method = view.inspection.settings.options.method.row().title;
  const char* lens = view.options.show.undistorted ? " · undistorted" : "";
  const char* extrapolated = is_extrapolated(view) ? " · extrapolated" : "";
  return fmt::format(
      "frame {} · {:.3f} s · {}{}{}", view.frame, seconds, method, lens, extrapolated);
}

}  // namespace

double cube_side(const Inspection& inspection, double chosen) {
  if (chosen > 0 || !inspection.cube) return chosen;
  return default_cube_side(*inspection.cube, inspection.initialization->plane.distance);
}

ShownImage as_shown(const Recording& recording) {
  return {recording.camera, recording.quarter_turns};
}

cv::Size shown_size(const Recording& recording) {
  const Vector2d size = as_shown(recording).size();
  return {static_cast<int>(size.x()), static_cast<int>(size.y())};
}

LegendHits draw_image_view(const Area& area, const FrameView& view, ImageTexture* image) {
  const auto& [inspection, frame, options] = view;
  const Camera& camera = inspection.recording->camera;
  const bool undistorted = options.show.undistorted;
  const Canvas canvas{
      {area,
       camera,
       map_image(as_shown(*inspection.recording), area.rect, options.image_zoom, undistorted)},
      view,
      image};
  area.clip();
  draw_image(canvas, image);
  LegendRows rows;
  if (view.inside()) {
    draw_results(canvas);
    rows = legend_rows(canvas);
    if (view.in_window() == 0) rows.push_back({Sign::none, 0, "reference frame"});
    if (is_extrapolated(view)) {
      draw_extrapolated_frame(canvas);
      rows.insert(rows.begin(), extrapolation_row(view));
    }
  } else {
    const int first = inspection.window->start, last = first + inspection.window->frame_count() - 1;
    rows.push_back({Sign::none, 0, fmt::format("outside of the window {}–{}", first, last)});
    if (const auto& after = options.after; after && frame > last && !after->end.empty())
      rows.push_back({Sign::none, color_of(Role::warning), "no camera here: " + after->end});
  }
  LegendHits hits;
  if (options.show.legend && options.legend_line)
    hits =
        draw_legend_line(area, canvas.mapping.origin.y() - area.rect.min.y(), heading(view), rows);
  else if (options.show.legend)
    draw_legend(area, legend_corner(canvas, heading(view), rows), heading(view), rows);
  if (view.inside() && !inspection.initialization->ok && options.says_failure)
    draw_badge(area, color_of(Role::warning), "not initialized", inspection.initialization->reason);
  area.list.PopClipRect();
  return hits;
}

Inspection nothing_to_show(std::shared_ptr<const Recording> recording) {
  Inspection nothing;
  nothing.recording = std::move(recording);
  nothing.tracks = std::make_shared<const Tracks>();
  nothing.window = std::make_shared<const Window>();
  nothing.initialization = std::make_shared<const Initialization>();
  return nothing;
}

}  // namespace gpo
