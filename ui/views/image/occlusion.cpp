// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/image/occlusion.h"

#include "engine/window/tracks.h"
#include "ui/views/overlay/plane_style.h"

#include <algorithm>
#include <utility>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using Triangle = std::array<Vector2d, 3>;

/// Of the tracks' Delaunay triangles the longest side that still tells what is between them.
constexpr double kLongestSide = 0.15;  // of the picture's width

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

/// Where the frame sees the tracks of a plane, and those that are not on it [raw px].
struct Seen {
  std::vector<Vector2d> on_plane, elsewhere;
};

Seen seen_in(const Inspection& inspection, int frame, int plane) {
  const Tracks& tracks = *inspection.tracks;
  Seen seen;
  for (int track = 0; track < tracks.track_count(); ++track) {
    if (!tracks.seen(frame, track)) continue;
    const bool on_it = plane_of_track(*inspection.window, frame, track) == plane;
    (on_it ? seen.on_plane : seen.elsewhere).emplace_back(tracks.raw_px[frame].col(track));
  }
  return seen;
}

bool tells(const Triangle& triangle, const Seen& seen, double longest_px) {
  for (int i = 0; i < 3; ++i)
    if ((triangle[i] - triangle[(i + 1) % 3]).norm() > longest_px) return false;
  return std::ranges::none_of(seen.elsewhere,
                              [&](const Vector2d& point) { return inside(triangle, point); });
}

std::vector<Triangle> triangles_of(const Seen& seen, const Camera& camera) {
  const cv::Rect2f image(-1, -1, camera.width + 1.0F, camera.height + 1.0F);
  cv::Subdiv2D subdivision;
  subdivision.initDelaunay(cv::Rect(-1, -1, camera.width + 2, camera.height + 2));
  for (const Vector2d& point : seen.on_plane) {
    const cv::Point2f pixel(static_cast<float>(point.x()), static_cast<float>(point.y()));
    if (image.contains(pixel)) subdivision.insert(pixel);
  }
  std::vector<cv::Vec6f> found;
  subdivision.getTriangleList(found);
  std::vector<Triangle> triangles;
  for (const cv::Vec6f& t : found) {
    const Triangle triangle = {Vector2d(t[0], t[1]), Vector2d(t[2], t[3]), Vector2d(t[4], t[5])};
    if (tells(triangle, seen, kLongestSide * camera.width)) triangles.push_back(triangle);
  }
  return triangles;
}

/// All over the cube, its surface too.
std::vector<Vector3d> points_of(const std::array<Vector3d, 8>& corners) {
  constexpr int kSteps = 6;  // an edge
  const Vector3d &origin = corners[0], x = corners[1] - origin, y = corners[2] - origin,
                 z = corners[4] - origin;
  std::vector<Vector3d> points;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j)
      for (int k = 0; k <= kSteps; ++k)
        points.emplace_back(origin + (i * x + j * y + k * z) / kSteps);
  return points;
}

/// Some of the points are seen through the triangles, and all of those lie behind the plane.
bool hides(const Plane& plane,
           const std::vector<Triangle>& triangles,
           const Camera& camera,
           const Pose& pose,
           const std::vector<Vector3d>& points_w) {
  constexpr double kBehind = 1.02;  // times as far away: what stands on the plane's edge is not
  bool some = false;
  for (const Vector3d& point : points_w) {
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

std::vector<Occluder> occluders(const Inspection& inspection,
                                int frame_in_window,
                                const std::array<Vector3d, 8>& cube_corners_w) {
  const Camera& camera = inspection.recording->camera;
  const Pose& pose = inspection.initialization->cameras[frame_in_window];
  const auto points = points_of(cube_corners_w);
  std::vector<Occluder> found;
  for (const PlaneEstimate& estimate : inspection.initialization->planes) {
    if (estimate.number == inspection.window->leader) continue;
    auto triangles = triangles_of(seen_in(inspection, frame_in_window, estimate.number), camera);
    if (hides(estimate.plane, triangles, camera, pose, points))
      found.push_back({estimate.number, std::move(triangles)});
  }
  return found;
}

}  // namespace gpo
