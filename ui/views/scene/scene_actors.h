// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/look/orbit_camera.h"

#include <array>
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

/// Lines, or faces, or points, of any colors, on their way to one VTK actor. Not shaded.
class Shapes {
 public:
  Shapes();
  void line(const Eigen::Vector3d& a,
            const Eigen::Vector3d& b,
            std::uint32_t rgb,
            double alpha = 1);
  /// Joins them in turn; back to the first one too, where closed.
  void lines(std::span<const Eigen::Vector3d> points,
             bool closed,
             std::uint32_t rgb,
             double alpha = 1);
  void face(std::span<const Eigen::Vector3d> corners, std::uint32_t rgb, double alpha);
  void point(const Eigen::Vector3d& point, std::uint32_t rgb);

  /// All of them; `size_px`: width of lines, diameter of points.
  vtkSmartPointer<vtkActor> actor(double size_px) const;

 private:
  void color(std::uint32_t rgb, double alpha);
  vtkIdType add(const Eigen::Vector3d& point);

  vtkNew<vtkPoints> points_;
  vtkNew<vtkCellArray> vertices_, lines_, faces_;
  vtkNew<vtkUnsignedCharArray> colors_;  ///< one a cell: of one kind of cells only
};

/// Makes VTK see what the orbit camera sees.
void set_camera_from_orbit(vtkCamera& vtk, const OrbitCamera& camera);

}  // namespace gpo
