// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_actors.h"

#include "ui/look/palette.h"

#include <array>
#include <cmath>

#include <vtkCamera.h>
#include <vtkCellData.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

namespace gpo {

using Eigen::Vector3d;

Shapes::Shapes() {
  points_->SetDataTypeToDouble();
  colors_->SetNumberOfComponents(4);
}

vtkIdType Shapes::add(const Vector3d& point) {
  return points_->InsertNextPoint(point.x(), point.y(), point.z());
}

void Shapes::color(std::uint32_t rgb, double alpha) {
  const auto byte = [](std::uint32_t value) { return static_cast<unsigned char>(value & 0xFF); };
  const std::array<unsigned char, 4> rgba = {
      byte(rgb >> 16), byte(rgb >> 8), byte(rgb), byte(std::lround(255 * alpha))};
  colors_->InsertNextTypedTuple(rgba.data());
}

void Shapes::line(const Vector3d& a, const Vector3d& b, std::uint32_t rgb) {
  lines_->InsertNextCell({add(a), add(b)});
  color(rgb);
}

void Shapes::lines(std::span<const Vector3d> points, bool closed, std::uint32_t rgb) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) line(points[i], points[i + 1], rgb);
  if (closed) line(points.back(), points.front(), rgb);
}

void Shapes::face(std::span<const Vector3d> corners, std::uint32_t rgb, double alpha) {
  faces_->InsertNextCell(static_cast<int>(corners.size()));
  for (const Vector3d& corner : corners) faces_->InsertCellPoint(add(corner));
  color(rgb, alpha);
}

void Shapes::point(const Vector3d& point, std::uint32_t rgb) {
  vertices_->InsertNextCell({add(point)});
  color(rgb);
}

vtkSmartPointer<vtkActor> Shapes::actor(double size_px) const {
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
  actor->GetProperty()->SetLighting(false);
  actor->GetProperty()->SetLineWidth(static_cast<float>(size_px));
  actor->GetProperty()->SetPointSize(static_cast<float>(size_px));
  actor->GetProperty()->SetRenderPointsAsSpheres(vertices_->GetNumberOfCells() > 0);
  return actor;
}

void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera) {
  vtk.SetPosition(eye(camera).eval().data());
  vtk.SetFocalPoint(camera.target.data());
  vtk.SetViewUp((-view_axes(camera).col(1)).eval().data());
  vtk.SetViewAngle(camera.view_angle_deg);
}

}  // namespace gpo
