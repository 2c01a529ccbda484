// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/image_geometry.h"

#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"
#include "engine/window/tracks.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

constexpr int kPiecesPerEdge = 24;
constexpr double kNear = 1e-3;  // nearest depth that is drawn [sides of the cube]

/// A corner of a face and its height on the cube, 0 to 1.
struct FaceCorner {
  Vector3d at_c;
  double height;
};

/// Returns the part of a polygon in which `n . P >= 0`.
std::vector<FaceCorner> cut(const std::vector<FaceCorner>& polygon, const Vector3d& n, double by) {
  std::vector<FaceCorner> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FaceCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double at_a = n.dot(a.at_c) - by, at_b = n.dot(b.at_c) - by;
    if (at_a >= 0) kept.push_back(a);
    if ((at_a < 0) == (at_b < 0)) continue;
    const double s = at_a / (at_a - at_b);
    kept.push_back({a.at_c + s * (b.at_c - a.at_c), a.height + s * (b.height - a.height)});
  }
  return kept;
}

/// Returns the half spaces `n . P >= by` that the image can show, with a margin: in front of the
/// camera, within the undistorted image.
std::array<std::pair<Vector3d, double>, 5> half_spaces_of_view(const Camera& camera, double near) {
  constexpr double kMargin = 0.05;
  Eigen::AlignedBox2d view;
  const Eigen::Matrix3d K_inverse = intrinsic_matrix(camera).inverse();
  for (const double u : {0.0, 0.5, 1.0})
    for (const double v : {0.0, 0.5, 1.0}) {
      const Vector2d raw_px(u * (camera.width - 1), v * (camera.height - 1));
      view.extend((K_inverse * undistort(camera, raw_px).homogeneous()).head<2>());
    }
  const Vector2d low = view.min() - kMargin * view.sizes(),
                 high = view.max() + kMargin * view.sizes();
  const Vector3d x = Vector3d::UnitX(), y = Vector3d::UnitY(), z = Vector3d::UnitZ();
  return {{{z, near},
           {x - low.x() * z, 0},
           {high.x() * z - x, 0},
           {y - low.y() * z, 0},
           {high.y() * z - y, 0}}};
}

/// Returns whether a projected pixel is near enough to the image to be drawn without cutting.
bool is_near_image(const Camera& camera, const Vector2d& raw_px) {
  constexpr double kFar = 20;  // [image sizes]
  return raw_px.allFinite() && raw_px.norm() < kFar * (camera.width + camera.height);
}

/// Projects points along a segment. Returns whether all of it can be projected near the image.
bool project_segment(const RollingCamera& camera,
                     const Vector3d& a_c,
                     const Vector3d& b_c,
                     double near,
                     Outline& longest) {
  Outline run;
  longest.clear();
  bool whole = true;
  for (int i = 0; i <= kPiecesPerEdge; ++i) {
    const double s = static_cast<double>(i) / kPiecesPerEdge;
    const Vector3d at_c = (1 - s) * a_c + s * b_c;
    const Vector2d raw_px = project(camera, at_c);
    const bool drawn = is_near_image(camera.camera, raw_px);
    whole = whole && drawn && at_c.z() >= near;
    drawn ? run.push_back(raw_px) : run.clear();
    if (run.size() > longest.size()) longest = run;
  }
  return whole;
}

/// Returns the longest visible part of a segment, cut at the image's border only if a part of it is
/// behind the camera, beyond the lens or far from the image.
Outline segment_in_image(const RollingCamera& camera, Vector3d a_c, Vector3d b_c, double near) {
  Outline line;
  if (project_segment(camera, a_c, b_c, near, line)) return line;
  for (const auto& [n, by] : half_spaces_of_view(camera.camera, near)) {
    const double at_a = n.dot(a_c) - by, at_b = n.dot(b_c) - by;
    if (at_a < 0 && at_b < 0) return {};
    if (at_a < 0) a_c += at_a / (at_a - at_b) * (b_c - a_c);
    if (at_b < 0) b_c += at_b / (at_b - at_a) * (a_c - b_c);
  }
  project_segment(camera, a_c, b_c, near, line);
  return line.size() < 2 ? Outline() : line;
}

/// Projects the sides of a polygon. Returns whether all of it can be projected.
bool project_sides(const RollingCamera& camera,
                   const std::vector<FaceCorner>& polygon,
                   double near,
                   CubeFace& face) {
  face.raw_px.clear();
  face.heights.clear();
  bool whole = true;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const FaceCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    for (int k = 0; k < kPiecesPerEdge; ++k) {
      const double s = static_cast<double>(k) / kPiecesPerEdge;
      const Vector3d at_c = (1 - s) * a.at_c + s * b.at_c;
      const Vector2d raw_px = project(camera, at_c);
      const bool drawn = is_near_image(camera.camera, raw_px);
      whole = whole && at_c.z() > near && drawn;
      if (!drawn) continue;
      face.raw_px.push_back(raw_px);
      face.heights.push_back(a.height + s * (b.height - a.height));
    }
  }
  return whole;
}

/// Cuts the face at the camera and at the image's border only if a part of it is behind or beyond
/// the lens.
CubeFace face_in_image(const RollingCamera& camera,
                       const CubeCorners& corners_c,
                       const std::array<int, 4>& face,
                       double near) {
  const Vector3d middle = (corners_c[0] + corners_c[7]) / 2;
  Vector3d center = Vector3d::Zero();
  std::vector<FaceCorner> polygon;
  for (const int corner : face) {
    center += corners_c[corner] / 4;
    polygon.push_back({corners_c[corner], corner >> 2 != 0 ? 1.0 : 0.0});
  }
  CubeFace result{face, face == kCubeFaces[0], center.dot(center - middle) < 0, {}, {}};
  if (project_sides(camera, polygon, near, result)) return result;
  for (const auto& [n, by] : half_spaces_of_view(camera.camera, near))
    polygon = cut(polygon, n, by);
  project_sides(camera, polygon, near, result);
  if (result.raw_px.size() < 3) result.raw_px.clear();
  return result;
}

bool inside(const Triangle& triangle, const Vector2d& point) {
  int left = 0, right = 0;
  for (int i = 0; i < 3; ++i) {
    const Vector2d side = triangle[(i + 1) % 3] - triangle[i], to = point - triangle[i];
    const double turn = side.x() * to.y() - side.y() * to.x();
    left += turn > 0;
    right += turn < 0;
  }
  return left == 0 || right == 0;
}

/// Returns the triangles of a plane's tracks in which the frame is assumed to show the plane.
std::vector<Triangle> triangles_of(const Inspection& inspection, int frame, int plane) {
  constexpr double kLongestSide = 0.15;  // in a triangle [widths of the image]
  const Tracks& tracks = *inspection.tracks;
  const Camera& camera = inspection.recording->camera;
  const cv::Rect2f image(-1, -1, camera.width + 1.0F, camera.height + 1.0F);
  cv::Subdiv2D subdivision;
  subdivision.initDelaunay(cv::Rect(-1, -1, camera.width + 2, camera.height + 2));
  Outline elsewhere;
  for (int track = 0; track < tracks.track_count(); ++track) {
    if (!tracks.seen(frame, track)) continue;
    const Vector2d raw_px = tracks.raw_px[frame].col(track);
    const cv::Point2f pixel(static_cast<float>(raw_px.x()), static_cast<float>(raw_px.y()));
    if (plane_of_track(*inspection.window, frame, track) != plane)
      elsewhere.push_back(raw_px);
    else if (image.contains(pixel))
      subdivision.insert(pixel);
  }
  std::vector<cv::Vec6f> found;
  subdivision.getTriangleList(found);
  std::vector<Triangle> triangles;
  for (const cv::Vec6f& t : found) {
    const Triangle triangle = {Vector2d(t[0], t[1]), Vector2d(t[2], t[3]), Vector2d(t[4], t[5])};
    double longest = 0;
    for (int i = 0; i < 3; ++i)
      longest = std::max(longest, (triangle[i] - triangle[(i + 1) % 3]).norm());
    const auto contains = [&](const Vector2d& point) { return inside(triangle, point); };
    if (longest <= kLongestSide * camera.width && std::ranges::none_of(elsewhere, contains))
      triangles.push_back(triangle);
  }
  return triangles;
}

/// Returns true if parts of the cube are seen through the triangles, all of them behind the plane.
bool hides(const Inspection& inspection,
           int frame,
           const Plane& plane,
           const std::vector<Triangle>& triangles,
           const CubeCorners& cube_w) {
  const RollingCamera camera = rolling_camera(inspection, frame);
  const Pose& pose = inspection.initialization->cameras[frame];
  constexpr double kBehind = 1.02;  // ratio of distances: a cube on the plane's edge is not hidden
  constexpr int kSteps = 6, kPoints = kSteps + 1;  // along an edge
  const Vector3d x = cube_w[1] - cube_w[0], y = cube_w[2] - cube_w[0], z = cube_w[4] - cube_w[0];
  bool some = false;
  for (int k = 0; k < kPoints * kPoints * kPoints; ++k) {
    const Vector3d steps(k % kPoints, k / kPoints % kPoints, k / (kPoints * kPoints));
    const Vector3d point = cube_w[0] + (steps.x() * x + steps.y() * y + steps.z() * z) / kSteps;
    const Vector3d point_c = to_camera(pose, point);
    if (point_c.z() <= 0) return false;
    const Vector2d raw_px = project(camera, point_c);
    const auto shows = [&](const Triangle& triangle) { return inside(triangle, raw_px); };
    if (!raw_px.allFinite() || std::ranges::none_of(triangles, shows)) continue;
    const auto on_plane = intersect(plane, pose, point_c);
    if (!on_plane || (point - pose.p_wc).norm() < kBehind * (*on_plane - pose.p_wc).norm())
      return false;
    some = true;
  }
  return some;
}

}  // namespace

CubeImage cube_in_image(const RollingCamera& camera,
                        const Pose& pose,
                        const CubeCorners& corners_w) {
  CubeCorners corners_c;
  for (int i = 0; i < 8; ++i) corners_c[i] = to_camera(pose, corners_w[i]);
  const double near = kNear * (corners_c[1] - corners_c[0]).norm();
  CubeImage result;
  for (const auto& face : kCubeFaces)
    result.faces.push_back(face_in_image(camera, corners_c, face, near));
  for (const auto& edge : kCubeEdges) {
    const int a = edge[0], b = edge[1];
    const bool hidden = std::ranges::none_of(result.faces, [&](const CubeFace& face) {
      return face.facing && std::ranges::count(face.corners, a) > 0 &&
             std::ranges::count(face.corners, b) > 0;
    });
    result.edges.push_back(
        {edge, b < 4, hidden, segment_in_image(camera, corners_c[a], corners_c[b], near)});
  }
  return result;
}

CubeImage cube_on(const Inspection& inspection,
                  int frame,
                  const CubeAnchor& anchor,
                  CubeSize size) {
  return cube_in_image(rolling_camera(inspection, frame),
                       inspection.initialization->cameras[frame],
                       cube_corners(anchor, size.side, size.height_sides));
}

std::optional<CubeImage> estimated_cube(const Inspection& inspection, int frame, CubeSize size) {
  if (!inspection.cube || !inspection.initialization->ok) return std::nullopt;
  return cube_on(inspection, frame, *inspection.cube, size);
}

std::vector<CubeAnchor> cubes_far_to_near(const Inspection& inspection, int frame) {
  std::vector<CubeAnchor> cubes = all_cubes(inspection);
  const Vector3d eye = inspection.initialization->cameras[frame].p_wc;
  std::ranges::stable_sort(
      cubes, std::greater(), [&](const CubeAnchor& cube) { return (cube.origin - eye).norm(); });
  return cubes;
}

std::optional<CubeAnchor> cube_at(const Inspection& inspection,
                                  int frame,
                                  CubeSize size,
                                  const Vector2d& raw_px) {
  std::optional<CubeAnchor> nearest;
  for (const CubeAnchor& anchor : cubes_far_to_near(inspection, frame)) {
    const CubeImage cube = cube_on(inspection, frame, anchor, size);
    const auto covers = [&](const CubeFace& face) { return is_inside(face.raw_px, raw_px); };
    if (std::ranges::any_of(cube.faces, covers)) nearest = anchor;
  }
  return nearest;
}

std::optional<CubeImage> true_cube(const Inspection& inspection, int frame, CubeSize size) {
  if (!inspection.true_cube || !inspection.cube || !inspection.truth ||
      !inspection.truth->cameras[frame])
    return std::nullopt;
  const double true_side = size.side * inspection.true_cube->unit / inspection.cube->unit;
  return cube_in_image(true_rolling_camera(inspection, frame),
                       *inspection.truth->cameras[frame],
                       cube_corners(*inspection.true_cube, true_side, size.height_sides));
}

CubeImage exaggerated(CubeImage cube, const CubeImage& reference, double times) {
  const auto exaggerate = [times](Outline& line, const Outline& from) {
    if (line.size() != from.size()) return line.clear();
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = from[i] + times * (line[i] - from[i]);
  };
  for (std::size_t i = 0; i < cube.edges.size(); ++i)
    exaggerate(cube.edges[i].raw_px, reference.edges[i].raw_px);
  for (std::size_t i = 0; i < cube.faces.size(); ++i)
    exaggerate(cube.faces[i].raw_px, reference.faces[i].raw_px);
  return cube;
}

Outlines contact_shadow(const Inspection& inspection,
                        int frame,
                        const CubeAnchor& anchor,
                        double side) {
  constexpr int kRings = 16, kPoints = 48;
  constexpr double kReach = 0.35;  // [sides]
  const auto base = cube_corners(anchor, side);
  const RollingCamera camera = rolling_camera(inspection, frame);
  const Pose& pose = inspection.initialization->cameras[frame];
  Outlines rings;
  for (int ring = kRings; ring > 0; --ring) {
    const double reach = kReach * side * ring / kRings;
    Outline outline;
    for (int i = 0; i < kPoints; ++i) {
      // Minkowski sum of a square and a disc: a square with round corners.
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kPoints;
      const double x = std::cos(angle), y = std::sin(angle);
      const Vector3d& corner = base[(x > 0 ? 1 : 0) | (y > 0 ? 2 : 0)];
      const Vector3d point_c =
          to_camera(pose, corner + reach * (x * anchor.axes.col(0) + y * anchor.axes.col(1)));
      if (point_c.z() < kNear * side) return {};
      outline.push_back(project(camera, point_c));
      if (!outline.back().allFinite()) return {};
    }
    rings.push_back(std::move(outline));
  }
  return rings;
}

Outlines horizon_in_image(RollingCamera camera, const Pose& pose, const Vector3d& up_w) {
  camera.motion = scaled(camera.motion, 0);  // it is far away
  constexpr int kDirections = 720;
  constexpr double kLeastDepth = 0.05;
  const Vector3d up_c = (pose.R_wc.transpose() * up_w).normalized();
  // Begins behind the camera, so that the visible part is in one piece.
  Vector3d ahead = Vector3d::UnitZ() - up_c * up_c.z();
  if (ahead.norm() < 1e-9) return {};
  ahead.normalize();
  const Vector3d side = ahead.cross(up_c);
  const Eigen::AlignedBox2d inside(Vector2d(-0.5, -0.5),
                                   Vector2d(camera.camera.width - 0.5, camera.camera.height - 0.5));
  Outlines pieces(1);
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
  std::erase_if(pieces, [](const Outline& piece) { return piece.size() < 2; });
  return pieces;
}

std::vector<Occluder> occluders(const Inspection& inspection,
                                int frame,
                                const CubeCorners& cube_w,
                                std::optional<int> of_plane) {
  const int own = of_plane.value_or(inspection.window->leader);
  std::vector<Occluder> found;
  for (const PlaneEstimate& estimate : inspection.initialization->planes) {
    if (estimate.number == own) continue;
    auto triangles = triangles_of(inspection, frame, estimate.number);
    if (hides(inspection, frame, estimate.plane, triangles, cube_w))
      found.push_back({estimate.number, std::move(triangles)});
  }
  return found;
}

}  // namespace gpo
