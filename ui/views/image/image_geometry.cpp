// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_geometry.h"

#include "engine/geometry/homography.h"
#include "engine/inspection/studies/track_life.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kPiecesOfAnEdge = 24;
constexpr double kNear = 1e-3;  // of the cube's side: what is nearer to the camera is cut off

/// Faces as corners in turn, each bit of a corner's index being one axis.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};

/// The longest stretch of the segment that the camera sees.
std::vector<Vector2d> segment_in_image(const Camera& camera,
                                         Vector3d a_c,
                                         Vector3d b_c,
                                         double near) {
  if (a_c.z() < near && b_c.z() < near) return {};
  const auto cut = [near](const Vector3d& inside, const Vector3d& outside) -> Vector3d {
    return inside + (outside - inside) * ((inside.z() - near) / (inside.z() - outside.z()));
  };
  if (a_c.z() < near) a_c = cut(b_c, a_c);
  if (b_c.z() < near) b_c = cut(a_c, b_c);
  std::vector<Vector2d> longest, run;
  for (int i = 0; i <= kPiecesOfAnEdge; ++i) {
    const double s = static_cast<double>(i) / kPiecesOfAnEdge;
    const Vector2d raw_px = project(camera, (1 - s) * a_c + s * b_c);
    if (raw_px.allFinite())
      run.push_back(raw_px);
    else
      run.clear();
    if (run.size() > longest.size()) longest = run;
  }
  if (longest.size() < 2) longest.clear();
  return longest;
}

bool contains_edge(const std::array<int, 4>& face, int a, int b) {
  return std::count(face.begin(), face.end(), a) > 0 && std::count(face.begin(), face.end(), b) > 0;
}

CubeFace face_in_image(const Camera& camera,
                         const std::array<Vector3d, 8>& corners_c,
                         const std::array<int, 4>& face,
                         double near) {
  const Vector3d middle = (corners_c[0] + corners_c[7]) / 2;
  Vector3d center = Vector3d::Zero();
  for (const int corner : face) center += corners_c[corner] / 4;
  CubeFace result{face, face == kFaces[0], center.dot(center - middle) < 0, {}};
  for (int i = 0; i < 4; ++i) {
    const Vector3d& a = corners_c[face[i]];
    const Vector3d& b = corners_c[face[(i + 1) % 4]];
    const auto side = a.z() > near && b.z() > near ? segment_in_image(camera, a, b, near)
                                                   : std::vector<Vector2d>{};
    if (side.size() != kPiecesOfAnEdge + 1) return {face, result.base, result.facing, {}};
    result.raw_px.insert(result.raw_px.end(), side.begin(), side.end() - 1);
  }
  return result;
}

}  // namespace

CubeImage cube_in_image(const Camera& camera,
                            const Pose& pose,
                            const std::array<Vector3d, 8>& corners_w) {
  std::array<Vector3d, 8> corners_c;
  for (int i = 0; i < 8; ++i) corners_c[i] = to_camera(pose, corners_w[i]);
  const double near = kNear * (corners_c[1] - corners_c[0]).norm();
  CubeImage result;
  for (const auto& face : kFaces)
    result.faces.push_back(face_in_image(camera, corners_c, face, near));
  for (int a = 0; a < 8; ++a)
    for (const int axis : {1, 2, 4}) {
      const int b = a | axis;
      if (b == a) continue;
      const bool hidden =
          std::none_of(result.faces.begin(), result.faces.end(), [&](const auto& f) {
            return f.facing && contains_edge(f.corners, a, b);
          });
      result.edges.push_back(
          {{a, b}, b < 4, hidden, segment_in_image(camera, corners_c[a], corners_c[b], near)});
    }
  return result;
}

std::optional<CubeImage> estimated_cube(const Inspection& inspection,
                                          int frame_in_window,
                                          double side,
                                          double height_sides) {
  if (!inspection.cube || !inspection.initialization->ok) return std::nullopt;
  return cube_in_image(inspection.recording->camera,
                         inspection.initialization->cameras[frame_in_window],
                         cube_corners(*inspection.cube, side, height_sides));
}

std::optional<CubeImage> true_cube(const Inspection& inspection,
                                     int frame_in_window,
                                     double side,
                                     double height_sides) {
  if (!inspection.true_cube || !inspection.cube || !inspection.truth ||
      !inspection.truth->cameras[frame_in_window])
    return std::nullopt;
  const double true_side = side * inspection.true_cube->unit / inspection.cube->unit;
  return cube_in_image(inspection.recording->camera,
                         *inspection.truth->cameras[frame_in_window],
                         cube_corners(*inspection.true_cube, true_side, height_sides));
}

namespace {

std::vector<Vector2d> exaggerated(const std::vector<Vector2d>& points,
                                  const std::vector<Vector2d>& reference,
                                  double times) {
  if (points.size() != reference.size()) return {};
  std::vector<Vector2d> moved;
  for (std::size_t i = 0; i < points.size(); ++i)
    moved.push_back(reference[i] + times * (points[i] - reference[i]));
  return moved;
}

}  // namespace

CubeImage exaggerated(const CubeImage& cube, const CubeImage& reference, double times) {
  CubeImage result = cube;
  for (std::size_t i = 0; i < cube.edges.size(); ++i)
    result.edges[i].raw_px = exaggerated(cube.edges[i].raw_px, reference.edges[i].raw_px, times);
  for (std::size_t i = 0; i < cube.faces.size(); ++i)
    result.faces[i].raw_px = exaggerated(cube.faces[i].raw_px, reference.faces[i].raw_px, times);
  return result;
}

std::vector<std::vector<Vector2d>> contact_shadow(const Inspection& inspection,
                                                  int frame_in_window,
                                                  double side) {
  constexpr int kRings = 16, kPoints = 48;
  constexpr double kReach = 0.35;  // of the side
  if (!inspection.cube || !inspection.initialization->ok) return {};
  const CubeAnchor& anchor = *inspection.cube;
  const auto base = cube_corners(anchor, side);
  const Pose& pose = inspection.initialization->cameras[frame_in_window];
  std::vector<std::vector<Vector2d>> rings;
  for (int ring = kRings; ring > 0; --ring) {
    const double reach = kReach * side * ring / kRings;
    std::vector<Vector2d> outline;
    for (int i = 0; i < kPoints; ++i) {
      // A square and a disc added up (Minkowski): a square with round corners.
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kPoints;
      const double x = std::cos(angle), y = std::sin(angle);
      const Vector3d& corner = base[(x > 0 ? 1 : 0) | (y > 0 ? 2 : 0)];
      const Vector3d point_c =
          to_camera(pose, corner + reach * (x * anchor.axes.col(0) + y * anchor.axes.col(1)));
      if (point_c.z() < kNear * side) return {};
      outline.push_back(project(inspection.recording->camera, point_c));
      if (!outline.back().allFinite()) return {};
    }
    rings.push_back(std::move(outline));
  }
  return rings;
}

std::vector<std::vector<Vector2d>> horizon_in_image(const Camera& camera,
                                                      const Pose& pose,
                                                      const Vector3d& up_w) {
  constexpr int kDirections = 720;  // around the whole horizon
  constexpr double kLeastDepth = 0.05;
  const Vector3d up_c = (pose.R_wc.transpose() * up_w).normalized();
  // Begins behind the camera, so that what it sees is in one piece.
  Vector3d ahead = Vector3d::UnitZ() - up_c * up_c.z();
  if (ahead.norm() < 1e-9) return {};
  ahead.normalize();
  const Vector3d side = ahead.cross(up_c);
  const Eigen::AlignedBox2d inside(Vector2d(-0.5, -0.5),
                                   Vector2d(camera.width - 0.5, camera.height - 0.5));
  std::vector<std::vector<Vector2d>> pieces(1);
  for (int i = 0; i <= kDirections; ++i) {
    const double angle = std::numbers::pi * (2.0 * i / kDirections - 1);
    const Vector3d direction = std::cos(angle) * ahead + std::sin(angle) * side;
    const Vector2d raw_px = direction.z() > kLeastDepth
                                ? project(camera, direction)
                                : Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    if (raw_px.allFinite() && inside.contains(raw_px))
      pieces.back().push_back(raw_px);
    else if (!pieces.back().empty())
      pieces.emplace_back();
  }
  std::erase_if(pieces, [](const auto& piece) { return piece.size() < 2; });
  return pieces;
}

std::vector<ResidualVector> residual_vectors(const Inspection& inspection, int frame_in_window) {
  const Window& window = *inspection.window;
  const auto H = estimated_homography(inspection, frame_in_window);
  if (!H) return {};
  std::vector<ResidualVector> residuals;
  for (int track = 0; track < window.track_count(); ++track) {
    if (!window.inlier[frame_in_window][track]) continue;
    const Vector2d predicted =
        distort(inspection.recording->camera, transfer(*H, window.points_px[0].col(track)));
    const Vector2d observed = inspection.tracks->raw_px[frame_in_window].col(track);
    if (predicted.allFinite() && observed.allFinite())
      residuals.push_back({track, observed, predicted});
  }
  return residuals;
}

std::optional<Eigen::Vector3d> point_on_plane(const Inspection& inspection,
                                              int frame_in_window,
                                              const Eigen::Vector2d& raw_px,
                                              const Plane& plane) {
  const auto& cameras = inspection.initialization->cameras;
  if (frame_in_window < 0 || frame_in_window >= static_cast<int>(cameras.size()))
    return std::nullopt;
  const Camera& camera = inspection.recording->camera;
  const Eigen::Vector3d ray =
      intrinsic_matrix(camera).inverse() * undistort(camera, raw_px).homogeneous();
  return intersect(plane, cameras[frame_in_window], ray);
}

}  // namespace gpo
