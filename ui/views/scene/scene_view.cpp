// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_view.h"

#include "engine/inspection/studies/studies.h"
#include "ui/context/vtk_window.h"
#include "ui/views/image/image_geometry.h"

#include <algorithm>

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

namespace gpo {
namespace {

/// Collects lines, or faces, or points, in any colors, for a VTK actor without shading.
class Shapes {
 public:
  Shapes() {
    points_->SetDataTypeToDouble();
    colors_->SetNumberOfComponents(4);
  }
  void line(const Vector3d& a, const Vector3d& b, std::uint32_t rgb) {
    const std::array<Vector3d, 2> ends = {a, b};
    add_cell(*lines_, ends, rgb);
  }
  /// Joins the points in turn; if `closed` also the last to the first.
  void lines(std::span<const Vector3d> points, bool closed, std::uint32_t rgb) {
    for (std::size_t i = 0; i + 1 < points.size(); ++i) line(points[i], points[i + 1], rgb);
    if (closed) line(points.back(), points.front(), rgb);
  }
  void face(std::span<const Vector3d> corners, std::uint32_t rgb, double alpha) {
    add_cell(*faces_, corners, rgb, alpha);
  }
  void point(const Vector3d& point, std::uint32_t rgb) { add_cell(*vertices_, {&point, 1}, rgb); }

  /// `size_px`: width of lines, diameter of points.
  vtkSmartPointer<vtkActor> actor(double size_px) const {
    vtkNew<vtkPolyData> data;
    data->SetPoints(points_);
    data->SetVerts(vertices_);
    data->SetLines(lines_);
    data->SetPolys(faces_);
    data->GetCellData()->SetScalars(colors_);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    vtkProperty& property = *actor->GetProperty();
    property.SetLighting(false);
    property.SetLineWidth(static_cast<float>(size_px));
    property.SetPointSize(static_cast<float>(size_px));
    property.SetRenderPointsAsSpheres(vertices_->GetNumberOfCells() > 0);
    return actor;
  }

 private:
  void add_cell(vtkCellArray& cells,
                std::span<const Vector3d> points,
                std::uint32_t rgb,
                double alpha = 1) {
    cells.InsertNextCell(static_cast<int>(points.size()));
    for (const Vector3d& point : points)
      cells.InsertCellPoint(points_->InsertNextPoint(point.data()));
    Eigen::Vector4d rgba(red(rgb), green(rgb), blue(rgb), alpha);
    rgba = (255 * rgba).array().round();
    colors_->InsertNextTuple(rgba.data());
  }

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> vertices_, lines_, faces_;
  vtkNew<vtkUnsignedCharArray> colors_;  ///< one per cell: of one kind of cells only
};

/// Dims a color towards the background; opaque, so that depth is right.
std::uint32_t dimmed(std::uint32_t rgb, double share) {
  return mixed_rgb(color_of(Role::scene_bottom), rgb, share);
}

struct SceneStage {
  vtkRenderer& renderer;
  const Inspection& inspection;
  const ViewOptions& options;
  double scale;  ///< for sizes in pixels

  double side() const { return cube_side(inspection, options.cube_side); }
  std::uint32_t color(const MapPoint& point, std::uint32_t by_plane) const {
    return options.colors ? options.colors->rgb(point.track) : by_plane;
  }
  void add(const Shapes& shapes, double size_px = 1) const {
    renderer.AddActor(shapes.actor(size_px * scale));
  }
  /// Map points grow less than text, as marks in the image do: hundreds would bury the scene.
  void add_marks(const Shapes& points) const {
    add(points, options.show.point_size_px / std::sqrt(overlay_scale()));
  }
  void add_polygon(std::span<const Vector3d> corners,
                   std::uint32_t rgb,
                   double alpha,
                   std::uint32_t border_rgb) const {
    Shapes border, face;
    border.lines(corners, true, border_rgb);
    face.face(corners, rgb, alpha);
    add(face);
    add(border, 1.8);
  }
};

void add_frustum(Shapes& shapes, const Frustum& corners, std::uint32_t rgb) {
  for (int k = 1; k <= 4; ++k) shapes.line(corners[0], corners[k], rgb);
  shapes.lines(std::span(corners).subspan(1, 4), true, rgb);
}

void add_reference(const SceneStage& stage, const Frustum& corners) {
  const std::uint32_t rgb = color_of(Role::reference);
  Shapes lines, face;
  add_frustum(lines, corners, rgb);
  const std::array<Vector3d, 3> mark = {corners[1], corners[2], corners[5]};
  lines.lines(mark, true, rgb);
  face.face(std::span(corners).subspan(1, 4), rgb, 0.12);
  face.face(mark, rgb, 0.24);
  stage.add(lines, 1.8);
  stage.add(face);
}

void add_cameras(const SceneStage& stage) {
  const Inspection& inspection = stage.inspection;
  const std::vector<Pose>& cameras = found_cameras(*inspection.initialization);
  if (cameras.empty()) return;
  const std::uint32_t rgb = inspection.initialization->ok
                                ? inspection.settings.options.method.row().rgb
                                : color_of(Role::bad);
  const double depth = frustum_depth(inspection);
  const Camera& camera = inspection.recording->camera;
  const int stride = frustum_stride(inspection);
  Shapes frusta, path;
  std::vector<Vector3d> centers;
  for (int i = 0; i < std::ssize(cameras); ++i) {
    centers.push_back(cameras[i].p_wc);
    if (i % stride == 0 && i != 0)
      add_frustum(frusta, frustum(camera, cameras[i], depth), dimmed(rgb, 0.75));
  }
  path.lines(centers, false, mixed_rgb(rgb, color_of(Role::text), 0.35));
  stage.add(frusta, 1.2);
  stage.add(path, 2.6);
  add_reference(stage, frustum(camera, cameras[0], depth));
}

void add_truth(const SceneStage& stage, const std::optional<PlaneGrid>& grid) {
  const Inspection& inspection = stage.inspection;
  const std::map<int, Pose> cameras = true_cameras(inspection);
  if (cameras.empty()) return;
  const std::uint32_t rgb = color_of(Role::truth);
  const double depth = 0.75 * frustum_depth(inspection);
  const int stride = frustum_stride(inspection);
  Shapes frusta, path, plane;
  std::vector<Vector3d> centers;
  for (const auto& [i, pose] : cameras) {
    centers.push_back(pose.p_wc);
    if (i % stride == 0)
      add_frustum(frusta, frustum(inspection.recording->camera, pose, depth), dimmed(rgb, 0.6));
  }
  path.lines(centers, false, rgb);
  stage.add(frusta, 1);
  stage.add(path, 1.6);
  if (!grid) return;
  if (const auto border = true_plane_border(inspection, *grid)) {
    plane.lines(*border, true, rgb);
    stage.add(plane, 1.8);
  }
}

/// The face is a little farther from the eye than the lines on it.
void add_plane(const SceneStage& stage, const PlaneGrid& grid, bool above) {
  Shapes lines, border, face;
  const std::uint32_t rgb = color_of(Role::plane);
  const auto [i0, j0] = grid.low;
  const auto [i1, j1] = grid.high;
  for (int i = i0 + 1; i < i1; ++i) lines.line(grid.at(i, j0), grid.at(i, j1), dimmed(rgb, 0.42));
  for (int j = j0 + 1; j < j1; ++j) lines.line(grid.at(i0, j), grid.at(i1, j), dimmed(rgb, 0.42));
  auto corners = grid.corners();
  border.lines(corners, true, dimmed(rgb, 0.8));
  for (Vector3d& corner : corners) corner += (above ? -0.02 : 0.02) * grid.cell * grid.normal;
  face.face(corners, rgb, 0.1);
  stage.add(face);
  stage.add(lines, 1.1);
  stage.add(border, 1.8);
}

void add_points(const SceneStage& stage, const PlaneGrid& grid) {
  Shapes points;
  for (const MapPoint& point : stage.inspection.initialization->points) {
    const Vector3d from = point.position - grid.origin;
    const double i = grid.x.dot(from) / grid.cell, j = grid.y.dot(from) / grid.cell;
    // Points outside of the grid are gross errors.
    if (i >= grid.low[0] && i <= grid.high[0] && j >= grid.low[1] && j <= grid.high[1])
      points.point(point.position, stage.color(point, color_of(Role::map_point)));
  }
  stage.add_marks(points);
}

void add_patches(const SceneStage& stage) {
  for (const PlanePatch& patch : plane_patches(stage.inspection)) {
    const std::uint32_t rgb = plane_color(patch.number);
    stage.add_polygon(patch.corners, rgb, 0.12, dimmed(rgb, 0.8));
    Shapes points;
    for (const MapPoint& point : patch.points)
      points.point(point.position, stage.color(point, rgb));
    stage.add_marks(points);
  }
}

void add_cube(const SceneStage& stage, const CubeAnchor& anchor) {
  const auto corners = cube_corners(anchor, stage.side(), stage.options.cube_height_sides);
  Shapes base, edges, faces;
  for (const auto& [a, b] : kCubeEdges)
    if (b < 4)
      base.line(corners[a], corners[b], cube_color(anchor, *stage.inspection.window));
    else
      edges.line(corners[a], corners[b], color_of(Role::cube_edge));
  for (const auto& [a, b, c, d] : std::span(kCubeFaces).subspan(1)) {
    const std::array<Vector3d, 4> face = {corners[a], corners[b], corners[c], corners[d]};
    faces.face(face, cube_face_color(anchor, *stage.inspection.window), 0.14);
  }
  stage.add(faces);
  stage.add(edges, 1.8);
  stage.add(base, 3);
}

/// Adds the model in the cube's place, with its own light.
void add_model(const SceneStage& stage, const CubeAnchor& anchor, const SolidModel& model) {
  const auto corners = cube_corners(anchor, stage.side());
  const std::vector<Vector3d> points = placed_on(model, corners);
  Shapes base, faces;
  const std::array<Vector3d, 4> foot = {corners[0], corners[1], corners[3], corners[2]};
  base.lines(foot, true, cube_color(anchor, *stage.inspection.window));
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto& [a, b, c] = model.triangles[i];
    const std::array<Vector3d, 3> face = {points[a], points[b], points[c]};
    faces.face(face, lit_rgb(model, i, color_of(Role::cube_face)), 1);
  }
  stage.add(faces);
  stage.add(base, 3);
}

void add_uncertainty(const SceneStage& stage, const PlaneGrid& grid) {
  const Initialization& estimate = *stage.inspection.initialization;
  const auto& uncertainty = *estimate.uncertainty;
  const std::uint32_t rgb = color_of(Role::uncertain);
  const double enlarged = stage.options.show.uncertainty;
  const int stride = frustum_stride(stage.inspection);
  Shapes lines, arrow_line, face;
  const auto count = std::min(estimate.cameras.size(), uncertainty.center_covariances.size());
  for (int i = stride; i < static_cast<int>(count); i += stride)
    for (const auto& line : confidence_ellipsoid(
             estimate.cameras[i].p_wc, uncertainty.center_covariances[i], enlarged))
      lines.lines(line, true, rgb);
  const NormalArrow arrow = normal_arrow(stage.inspection, grid);
  const PlaneEstimate main = found_planes(stage.inspection).front();
  const auto rim = confidence_rim(
      arrow, main.normal_covariance.value_or(uncertainty.normal_covariance), enlarged);
  arrow_line.line(arrow.base, arrow.tip, color_of(Role::normal));
  for (const Vector3d& end : arrow.head) arrow_line.line(arrow.tip, end, color_of(Role::normal));
  lines.lines(rim, true, rgb);
  for (std::size_t k = 0; k < rim.size(); ++k) {
    const std::array<Vector3d, 3> side = {arrow.base, rim[k], rim[(k + 1) % rim.size()]};
    face.face(side, rgb, 0.1);
  }
  stage.add(face);
  stage.add(lines, 1.2);
  stage.add(arrow_line, 2.4);
}

void build(const SceneStage& stage, bool above) {
  const Inspection& inspection = stage.inspection;
  stage.renderer.RemoveAllViewProps();
  std::optional<PlaneGrid> grid;
  if (inspection.initialization->ok) grid = plane_grid(inspection, stage.side());
  if (stage.options.show.truth) add_truth(stage, grid);
  if (!grid) {
    for (const PlanePatch& patch : refused_patches(inspection))
      stage.add_polygon(patch.corners, color_of(Role::bad), 0.08, color_of(Role::bad));
    add_cameras(stage);
    return;
  }
  add_plane(stage, *grid, above);
  add_points(stage, *grid);
  add_patches(stage);
  add_cameras(stage);
  if (stage.options.show.cube)
    for (const CubeAnchor& anchor : all_cubes(inspection)) {
      if (stage.options.model)
        add_model(stage, anchor, *stage.options.model);
      else
        add_cube(stage, anchor);
    }
  if (shows_uncertainty(inspection, stage.options)) add_uncertainty(stage, *grid);
}

/// Returns true if both options draw the same shapes, at whatever detail.
bool same_shapes(ViewOptions a, const ViewOptions& b) {
  a.detail = b.detail;
  for (const ViewToggle& one : kViewToggles)
    if (!one.in_scene) a.show.*one.shown = b.show.*one.shown;
  for (const ViewNumber& one : kViewNumbers)
    if (!one.in_scene) a.show.*one.value = b.show.*one.value;
  return a == b;
}

}  // namespace

/// VTK's objects and their content. Holds the inspection's parts: equal address, equal content.
struct SceneView::Pipeline {
  vtkSmartPointer<VtkWindow> window = make_vtk_window();
  vtkNew<vtkRenderer> renderer;
  Inspection inspection;
  OrbitCamera camera;
  bool above = true;
  ViewOptions options;
  cv::Size size;
  double scale = 0;
  Theme theme = Theme::dark;
  unsigned texture = 0;
  std::size_t renders = 0;

  bool shows(const Inspection& other) const {
    return inspection.initialization == other.initialization && inspection.truth == other.truth &&
           inspection.window == other.window && inspection.cube == other.cube &&
           inspection.other_cubes == other.other_cubes;
  }
};

SceneView::SceneView() : pipeline_(std::make_unique<Pipeline>()) {
  vtkRenderer& renderer = *pipeline_->renderer;
  renderer.SetGradientBackground(true);
  renderer.SetBackgroundAlpha(1);
  pipeline_->window->AddRenderer(&renderer);
}

SceneView::~SceneView() { pipeline_->window->Finalize(); }

unsigned SceneView::render(const Inspection& inspection,
                           const ViewOptions& options,
                           const OrbitCamera& camera,
                           cv::Size size) {
  constexpr int kSamples = 4;  // per pixel
  constexpr double kDraggedSize = 0.5;
  Pipeline& now = *pipeline_;
  const double of_size = options.detail == SceneDetail::dragged ? kDraggedSize : 1;
  size = {static_cast<int>(of_size * size.width), static_cast<int>(of_size * size.height)};
  const double scale = of_size * overlay_scale();
  const Plane& plane = inspection.initialization->plane;
  const bool above =  // the eye is on the cameras' side of the plane
      !inspection.initialization->ok || plane.normal.dot(eye(camera)) + plane.distance > 0;
  const bool built = now.texture != 0 && now.shows(inspection) &&
                     same_shapes(now.options, options) && now.above == above &&
                     now.scale == scale && now.theme == current_theme();
  if (built && now.camera == camera && now.options.detail == options.detail && now.size == size)
    return now.texture;
  now.inspection = inspection;
  now.camera = camera;
  now.above = above;
  now.options = options;
  now.size = size;
  now.scale = scale;
  now.theme = current_theme();
  const std::uint32_t bottom = color_of(Role::scene_bottom), top = color_of(Role::scene_top);
  now.renderer->SetBackground(red(bottom), green(bottom), blue(bottom));
  now.renderer->SetBackground2(red(top), green(top), blue(top));
  // The shapes are kept if only the camera moves: fast enough without a graphics card.
  if (!built) build({*now.renderer, inspection, options, scale}, above);
  now.window->SetMultiSamples(options.detail == SceneDetail::full ? kSamples : 0);
  set_camera_from_orbit(*now.renderer->GetActiveCamera(), camera);
  now.renderer->ResetCameraClippingRange();
  now.texture = render_to_texture(*now.window, size.width, size.height);
  ++now.renders;
  return now.texture;
}

std::size_t SceneView::renders() const { return pipeline_->renders; }

}  // namespace gpo
