// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/scene/scene_actors.h"

#include "ui/look/palette.h"

#include <cmath>

#include <Eigen/Core>
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

void Shapes::line(const Vector3d& a, const Vector3d& b, std::uint32_t rgb, double alpha) {
  const std::array<vtkIdType, 2> ends = {add(a), add(b)};
  lines_->InsertNextCell(2, ends.data());
  color(rgb, alpha);
}

void Shapes::lines(std::span<const Vector3d> points, bool closed, std::uint32_t rgb, double alpha) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) line(points[i], points[i + 1], rgb, alpha);
  if (closed) line(points.back(), points.front(), rgb, alpha);
}

void Shapes::face(std::span<const Vector3d> corners, std::uint32_t rgb, double alpha) {
  faces_->InsertNextCell(static_cast<int>(corners.size()));
  for (const Vector3d& corner : corners) faces_->InsertCellPoint(add(corner));
  color(rgb, alpha);
}

void Shapes::point(const Vector3d& point, std::uint32_t rgb) {
  const vtkIdType id = add(point);
  vertices_->InsertNextCell(1, &id);
  color(rgb, 1);
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
  const Eigen::Vector3d position = eye(camera);
  const Eigen::Vector3d up = -view_axes(camera).col(1);
  vtk.SetPosition(position.x(), position.y(), position.z());
  vtk.SetFocalPoint(camera.target.x(), camera.target.y(), camera.target.z());
  vtk.SetViewUp(up.x(), up.y(), up.z());
  vtk.SetViewAngle(camera.view_angle_deg);
}

}  // namespace gpo
