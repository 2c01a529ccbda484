// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/orbit_camera.h"

#include <cstdint>
#include <span>

#include <Eigen/Core>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

class vtkCamera;

namespace gpo {

/// Collects lines, or faces, or points, in any colors, for a VTK actor without shading.
class Shapes {
 public:
  Shapes();
  void line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::uint32_t rgb);
  /// Joins the points in turn; if `closed` also the last to the first.
  void lines(std::span<const Eigen::Vector3d> points, bool closed, std::uint32_t rgb);
  void face(std::span<const Eigen::Vector3d> corners, std::uint32_t rgb, double alpha);
  void point(const Eigen::Vector3d& point, std::uint32_t rgb);

  /// `size_px`: width of lines, diameter of points.
  vtkSmartPointer<vtkActor> actor(double size_px) const;

 private:
  void color(std::uint32_t rgb, double alpha = 1);
  vtkIdType add(const Eigen::Vector3d& point);

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> vertices_, lines_, faces_;
  vtkNew<vtkUnsignedCharArray> colors_;  ///< one per cell: of one kind of cells only
};

/// Gives the VTK camera the orbit camera's view.
void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera);

}  // namespace gpo
