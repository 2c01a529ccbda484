// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ui/views/image/image_view.h"

#include <map>

namespace gpo {

/// Transforms the truth to the estimate's world: by the aligned paths if they determine it,
/// otherwise by the reference camera and a scale, from the alignment or the plane's true distance.
std::optional<Similarity> estimate_from_truth(const Inspection& inspection);

/// Returns the meters per unit of lengths that are shown: measured by two points, else from the
/// truth, else from the accelerometer.
std::optional<double> shown_scale(const Inspection& inspection);

/// Returns the known true cameras in the estimate's world, by frame of the window.
std::map<int, Pose> true_cameras(const Inspection& inspection);

/// The camera's center, the corners of its image at a depth, clockwise from the top left, a mark.
using Frustum = std::array<Vector3d, 6>;
Frustum frustum(const Camera& camera, const Pose& pose, double depth);

/// Returns the cameras of the estimate or of the rejected solution.
const std::vector<Pose>& found_cameras(const Initialization& estimate);

/// Returns the depth at which frusta neither hide each other nor are too small.
double frustum_depth(const Inspection& inspection);

double axes_length(const Inspection& inspection);

/// Returns the step between frames with a frustum, for about ten in a path.
int frustum_stride(const Inspection& inspection);

/// Returns the largest number that is 1, 2 or 5 times a power of ten and not above `length`.
double nice_length(double length);

struct PlaneGrid {
  Vector3d origin;               ///< on the plane
  Vector3d x, y;                 ///< unit, along the plane
  Vector3d normal;               ///< unit, towards the cameras
  double cell = 0.1;             ///< a nice length, in meters if the scale is known
  std::array<int, 2> low, high;  ///< cells from the origin along x and y

  Vector3d at(double i, double j) const { return origin + cell * (i * x + j * y); }
  /// Returns the corners, in turn, `margin` cells outside.
  std::array<Vector3d, 4> corners(double margin = 0) const;
};

/// Returns the part of the estimated plane around map points and cube of a result that is ok.
PlaneGrid plane_grid(const Inspection& inspection, double cube_side);

/// Projects the grid's border, half a cell wider to show a tilt, onto the true plane, if known.
std::optional<std::array<Vector3d, 4>> true_plane_border(const Inspection& inspection,
                                                         const PlaneGrid& grid);

/// 95 % quantiles of chi-square for two and three degrees of freedom.
constexpr double kChiSquare2 = 5.991, kChiSquare3 = 7.815;

/// Returns three sections of a point's 95 % ellipsoid, through two axes each, enlarged.
std::array<std::vector<Vector3d>, 3> confidence_ellipsoid(const Vector3d& center,
                                                          const Eigen::Matrix3d& covariance,
                                                          double enlarged);

/// The plane's normal as an arrow on the plane.
struct NormalArrow {
  Vector3d base, tip;
  std::array<Vector3d, 4> head = {};  ///< ends of the lines of its head
};
/// Places the arrow in the middle of the grid's edge that is farthest from the cameras.
NormalArrow normal_arrow(const Inspection& inspection, const PlaneGrid& grid);

/// Returns the border of the tip's 95 % region, with enlarged angles, at most right ones.
std::vector<Vector3d> confidence_rim(const NormalArrow& arrow,
                                     const Eigen::Matrix3d& normal_covariance,
                                     double enlarged);

/// Returns the line on the disc (`disc_from_normal`) at this angle from a normal.
std::vector<Vector2d> circle_on_disc(const Vector3d& normal, double radius_deg);
/// Returns the border on the disc of a normal's 95 % region, from its covariance [rad^2].
std::vector<Vector2d> confidence_on_disc(const Vector3d& normal, const Eigen::Matrix3d& covariance);

/// Returns points that a view must contain: (true) cameras, plane and cube.
std::vector<Vector3d> scene_extent(const Inspection& inspection, double cube_side);

/// Views the whole scene from behind the reference camera, above and beside it.
OrbitCamera default_scene_camera(const Inspection& inspection, double cube_side, double aspect);

/// Views the scene from a viewpoint or through a camera (frame of the recording, the nearest one).
OrbitCamera scene_camera(
    const Inspection& inspection, double cube_side, double aspect, Viewpoint viewpoint, int frame);

bool shows_uncertainty(const Inspection& inspection, const ViewOptions& options);

/// The estimate in 3-D, rendered by VTK. Needs the context in which it was created to be current.
class SceneView {
 public:
  SceneView();
  ~SceneView();

  /// Returns the texture without items of one frame, bottom row first; 0: empty. Caches it.
  unsigned render(const Inspection& inspection,
                  const ViewOptions& options,
                  const OrbitCamera& camera,
                  cv::Size size);
  std::size_t renders() const;

 private:
  struct Pipeline;
  std::unique_ptr<Pipeline> pipeline_;
};

/// Draws the scene into the rectangle (whole pixels), with frame camera, labels, legend, scale bar.
void draw_scene_view(const Area& area,
                     const FrameView& view,
                     SceneView& scene,
                     const OrbitCamera& camera);

}  // namespace gpo
