// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/studies.h"
#include "ui/views/image/image_geometry.h"
#include "ui/views/report/report.h"
#include "ui/views/scene/scene_view.h"

#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMosaicCells = 64;  ///< along the longer side of a plane

std::string css_color(std::uint32_t rgb) { return fmt::format("#{:06x}", rgb); }
std::string css_color(Role role) { return css_color(color_of(role, Theme::light)); }

/// Rounds to five digits, less than a pixel of any scene.
double short_number(double value) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const double unit = std::pow(10.0, 4 - std::floor(std::log10(std::abs(value))));
  return std::round(value * unit) / unit;
}

Json point_json(const Vector3d& point) {
  return {short_number(point.x()), short_number(point.y()), short_number(point.z())};
}

Json points_json(std::span<const Vector3d> points) {
  Json list = Json::array();
  for (const Vector3d& point : points) list.push_back(point_json(point));
  return list;
}

/// Collects the items of a scene: kind, layer, points, color, opacity, width [px].
class SceneItems {
 public:
  Json& add(const char* kind,
            const char* layer,
            std::span<const Vector3d> points,
            const std::string& color) {
    items_.push_back(
        {{"kind", kind}, {"layer", layer}, {"points", points_json(points)}, {"color", color}});
    return items_.back();
  }
  Json& line(const char* layer,
             std::vector<Vector3d> points,
             bool closed,
             const std::string& color) {
    if (closed) points.push_back(points.front());
    return add("line", layer, points, color);
  }
  void push(Json item) { items_.push_back(std::move(item)); }
  Json take() { return std::move(items_); }

 private:
  Json items_ = Json::array();
};

/// The images that see a plane, nearest to the reference frame first.
struct PlanePainter {
  const Inspection& inspection;
  std::vector<std::pair<int, cv::Mat>> images{};  ///< index in the window, 8-bit BGR

  explicit PlanePainter(const Inspection& of) : inspection(of) {
    if (!of.recording->images) return;
    for (const int frame : report_frames(of))
      images.emplace_back(frame - of.window->start, of.recording->images->bgr(frame));
  }

  /// Returns the color around a point in the first image that shows it, as six digits; "------" if
  /// none does.
  std::string color_at(const Vector3d& point) const {
    const Camera& camera = inspection.recording->camera;
    for (const auto& [index, bgr] : images) {
      const Vector3d seen = to_camera(inspection.initialization->cameras[index], point);
      if (seen.z() < 0.05) continue;
      const Vector2d raw = project(camera, seen);
      const Vector2d back = undistort(camera, raw);
      // Beyond the lens model's range a projection does not map back.
      const Vector2d pinhole(camera.fx * seen.x() / seen.z() + camera.cx,
                             camera.fy * seen.y() / seen.z() + camera.cy);
      if (!raw.allFinite() || !back.allFinite() || (back - pinhole).norm() > 2) continue;
      const cv::Point pixel(static_cast<int>(std::lround(raw.x())),
                            static_cast<int>(std::lround(raw.y())));
      if (!cv::Rect(0, 0, bgr.cols, bgr.rows).contains(pixel)) continue;
      const cv::Rect around =
          cv::Rect(pixel.x - 2, pixel.y - 2, 5, 5) & cv::Rect(0, 0, bgr.cols, bgr.rows);
      const cv::Scalar mean = cv::mean(bgr(around));
      return fmt::format("{:02x}{:02x}{:02x}",
                         static_cast<int>(mean[2]),
                         static_cast<int>(mean[1]),
                         static_cast<int>(mean[0]));
    }
    return "------";
  }
};

/// Returns a plane as cells in the colors of the images; no item without images.
std::optional<Json> mosaic(const PlanePainter& painter,
                           const std::array<Vector3d, 4>& corners,
                           const char* layer) {
  if (painter.images.empty()) return std::nullopt;
  const Vector3d along = corners[1] - corners[0], across = corners[3] - corners[0];
  const double cell = std::max(along.norm(), across.norm()) / kMosaicCells;
  if (!(cell > 0)) return std::nullopt;
  const int columns = std::max(1, static_cast<int>(std::lround(along.norm() / cell)));
  const int rows = std::max(1, static_cast<int>(std::lround(across.norm() / cell)));
  const Vector3d x = along / columns, y = across / rows;
  std::string colors;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      colors += painter.color_at(corners[0] + (i + 0.5) * x + (j + 0.5) * y);
  return Json{{"kind", "mosaic"},
              {"layer", layer},
              {"at", point_json(corners[0])},
              {"x", point_json(x)},
              {"y", point_json(y)},
              {"columns", columns},
              {"rows", rows},
              {"alpha", 0.92},
              {"colors", colors}};
}

void add_plane_items(SceneItems& items, const PlanePainter& painter, const PlaneGrid& grid) {
  const std::string color = css_color(Role::plane);
  if (auto picture = mosaic(painter, grid.corners(), "picture")) items.push(std::move(*picture));
  const auto [i0, j0] = grid.low;
  const auto [i1, j1] = grid.high;
  for (int i = i0; i < i1; ++i)
    for (int j = j0; j < j1; ++j) {
      const std::vector<Vector3d> cell = {
          grid.at(i, j), grid.at(i + 1, j), grid.at(i + 1, j + 1), grid.at(i, j + 1)};
      items.add("face", "grid", cell, color)["alpha"] = 0.05;
      items.line("grid", {cell[0], cell[1]}, false, color)["alpha"] = 0.3;
      items.line("grid", {cell[0], cell[3]}, false, color)["alpha"] = 0.3;
    }
  const auto corners = grid.corners();
  items.line("grid", {corners.begin(), corners.end()}, true, color)["width"] = 1.6;
  for (const PlanePatch& patch : plane_patches(painter.inspection)) {
    if (auto picture = mosaic(painter, patch.corners, "picture")) items.push(std::move(*picture));
    Json& border = items.line("grid",
                              {patch.corners.begin(), patch.corners.end()},
                              true,
                              css_color(plane_color(patch.number)));
    border["width"] = 1.6;
    border["title"] = plane_title(painter.inspection, patch.number);
  }
}

void add_frustum_items(SceneItems& items, const Frustum& corners, const char* layer, Json style) {
  const auto add = [&](std::vector<Vector3d> points, bool closed) {
    items.line(layer, std::move(points), closed, style["color"].get<std::string>()).update(style);
  };
  for (int k = 1; k <= 4; ++k) add({corners[0], corners[k]}, false);
  add({corners.begin() + 1, corners.begin() + 5}, true);
}

void add_camera_items(SceneItems& items, const Inspection& inspection) {
  const std::vector<Pose>& cameras = found_cameras(*inspection.initialization);
  const std::string color =
      css_color(inspection.initialization->ok ? inspection.settings.options.method.row().rgb
                                              : color_of(Role::bad, Theme::light));
  const double depth = frustum_depth(inspection);
  const int stride = frustum_stride(inspection);
  const int start = inspection.window->start;
  std::vector<Vector3d> centers;
  const std::vector<int> shown = report_frames(inspection);
  for (int i = 0; i < std::ssize(cameras); ++i) {
    centers.push_back(cameras[i].p_wc);
    if (i % stride != 0 && std::ranges::find(shown, start + i) == shown.end()) continue;
    const Json style = {{"color", i == 0 ? css_color(Role::reference) : color},
                        {"alpha", i == 0 ? 1.0 : 0.75},
                        {"width", i == 0 ? 2.0 : 1.2},
                        {"frame", start + i},
                        {"title", fmt::format("camera of frame {}", start + i)}};
    add_frustum_items(
        items, frustum(inspection.recording->camera, cameras[i], depth), "cameras", style);
  }
  if (centers.size() > 1) items.line("cameras", centers, false, color)["width"] = 2.4;
}

void add_truth_items(SceneItems& items, const Inspection& inspection, const PlaneGrid* grid) {
  const std::string color = css_color(Role::truth);
  const int stride = frustum_stride(inspection);
  const Json style = {{"color", color}, {"alpha", 0.6}};
  std::vector<Vector3d> centers;
  const double depth = 0.75 * frustum_depth(inspection);
  for (const auto& [i, pose] : true_cameras(inspection)) {
    centers.push_back(pose.p_wc);
    if (i % stride == 0)
      add_frustum_items(items, frustum(inspection.recording->camera, pose, depth), "truth", style);
  }
  if (centers.size() > 1) items.line("truth", centers, false, color)["dashed"] = true;
  if (grid == nullptr) return;
  if (const auto border = true_plane_border(inspection, *grid))
    items.line("truth", {border->begin(), border->end()}, true, color)["dashed"] = true;
}

void add_point_items(SceneItems& items, const Inspection& inspection) {
  const auto add = [&](const MapPoint& point, std::uint32_t rgb) {
    Json& item = items.add("dot", "points", std::span(&point.position, 1), css_color(rgb));
    item["title"] = fmt::format("track {}", inspection.tracks->ids[point.track]);
    item["alpha"] = 0.85;
  };
  const std::vector<PlanePatch> patches = plane_patches(inspection);
  std::vector<bool> added(inspection.tracks->ids.size(), false);
  for (const PlanePatch& patch : patches)
    for (const MapPoint& point : patch.points) {
      add(point, plane_color(patch.number));
      added[point.track] = true;
    }
  for (const MapPoint& point : inspection.initialization->points)
    if (!added[point.track]) add(point, plane_color(inspection.window->leader));
}

void add_cube_items(SceneItems& items, const Inspection& inspection) {
  const double side = cube_side(inspection, 0);
  const Window& window = *inspection.window;
  for (const CubeAnchor& cube : all_cubes(inspection)) {
    const auto corners = cube_corners(cube, side);
    const std::string of_faces = css_color(cube_face_color(cube, window));
    const std::string of_base = css_color(cube_color(cube, window));
    const std::string of_edges = cube.plane ? of_base : css_color(Role::cube_edge);
    for (const auto& face : kCubeFaces) {
      std::vector<Vector3d> points;
      for (const int corner : face) points.push_back(corners[corner]);
      items.add("face", "cube", points, of_faces)["alpha"] = 0.35;
      const bool base = &face == &kCubeFaces.front();
      items.line("cube", points, true, base ? of_base : of_edges)["width"] = 1.8;
    }
  }
}

void add_arrow(SceneItems& items, const Vector3d& tip, const char* name, Role role) {
  const std::array<Vector3d, 2> ends = {Vector3d::Zero(), tip};
  items.add("line", "axes", ends, css_color(role))["width"] = 2.2;
  items.add("text", "axes", std::span(&tip, 1), css_color(role))["text"] = name;
}

void add_axes_items(SceneItems& items, const Inspection& inspection, const PlaneGrid* grid) {
  const double length = axes_length(inspection);
  constexpr std::array kNames{"x", "y", "z"};
  constexpr std::array kRoles{Role::axis_x, Role::axis_y, Role::axis_z};
  for (int k = 0; k < 3; ++k) add_arrow(items, length * Vector3d::Unit(k), kNames[k], kRoles[k]);
  if (inspection.inertial && inspection.inertial->ok)
    add_arrow(items, -length * inspection.inertial->gravity_m_s2.normalized(), "up", Role::gravity);
  if (grid == nullptr) return;
  const NormalArrow arrow = normal_arrow(inspection, *grid);
  const std::string color = css_color(Role::normal);
  items.line("axes", {arrow.base, arrow.tip}, false, color)["width"] = 2.2;
  for (const Vector3d& end : arrow.head) items.line("axes", {arrow.tip, end}, false, color);
  items.add("text", "axes", std::span(&arrow.tip, 1), color)["text"] = "normal";
}

Json camera_json_of(const OrbitCamera& camera) {
  return {{"target", point_json(camera.target)},
          {"up", point_json(camera.up)},
          {"front", point_json(camera.front)},
          {"yaw_deg", camera.yaw_deg},
          {"pitch_deg", camera.pitch_deg},
          {"distance", camera.distance},
          {"view_angle_deg", camera.view_angle_deg}};
}

}  // namespace

Json report_scene(const Inspection& inspection) {
  constexpr double kAspect = 16.0 / 9;
  SceneItems items;
  std::optional<PlaneGrid> grid;
  if (inspection.initialization->ok) {
    grid = plane_grid(inspection, cube_side(inspection, 0));
    add_plane_items(items, PlanePainter(inspection), *grid);
    add_point_items(items, inspection);
    add_cube_items(items, inspection);
  } else {
    for (const auto& [number, normal, corners, points] : refused_patches(inspection))
      items.line("grid", {corners.begin(), corners.end()}, true, css_color(Role::bad));
  }
  add_camera_items(items, inspection);
  add_truth_items(items, inspection, grid ? &*grid : nullptr);
  add_axes_items(items, inspection, grid ? &*grid : nullptr);
  const double side = cube_side(inspection, 0);
  Json scene = {{"camera", camera_json_of(default_scene_camera(inspection, side, kAspect))}};
  if (grid) scene["cell"] = distance_text(inspection, grid->at(0, 0), grid->at(1, 0));
  scene["items"] = items.take();
  return scene;
}

}  // namespace gpo
