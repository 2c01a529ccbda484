// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/external_methods/answered.h"

#include "engine/geometry/camera_resection.h"
#include "engine/geometry/plane.h"
#include "engine/geometry/statistics.h"
#include "engine/methods/common/window_checks.h"
#include "engine/methods/plane/plane_result.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector3d;

/// All in the axes of the reference camera.
Answer seen_from_reference(Answer answer) {
  const Pose reference = *answer.cameras.front();
  const Pose from_world = inverse(reference);
  for (auto& camera : answer.cameras)
    if (camera) camera = from_world * *camera;
  answer.cameras.front() = Pose{};
  const auto turn = [&](Plane& plane) { plane = facing_origin(plane_in_camera(plane, reference)); };
  if (answer.plane) turn(*answer.plane);
  for (PlaneEstimate& one : answer.planes) turn(one.plane);
  for (MapPoint& point : answer.points) point.position = to_camera(reference, point.position);
  std::erase_if(answer.points, [](const MapPoint& point) { return !(point.position.z() > 0); });
  return answer;
}

std::optional<Plane> plane_of_inliers(const Window& window, const std::vector<MapPoint>& points) {
  Eigen::Matrix3Xd positions(3, std::ssize(points));
  int count = 0;
  for (const MapPoint& point : points)
    if (window.is_inlier_track(point.track)) positions.col(count++) = point.position;
  return fit_plane(positions.leftCols(count));
}

/// Where the inliers' rays from the reference camera meet the plane.
std::vector<MapPoint> on_plane(const Window& window, const Plane& plane) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (const int j : window.inlier_tracks(0)) {
    const auto point =
        intersect(plane, Pose{}, K_inverse * window.points_px[0].col(j).homogeneous());
    if (point) points.push_back({j, *point});
  }
  return points;
}

/// In the gauge of its plane; nothing where numbers run over.
bool rescale(Answer& answer) {
  const double unit = answer.plane->distance;
  bool finite = true;
  const auto scale = [&](Vector3d& vector) {
    vector /= unit;
    finite = finite && vector.allFinite();
  };
  for (auto& camera : answer.cameras)
    if (camera) scale(camera->p_wc);
  for (MapPoint& point : answer.points) scale(point.position);
  for (PlaneEstimate& one : answer.planes) one.plane.distance /= unit;
  answer.plane->distance = 1;
  return finite && std::isfinite(1 / unit);
}

/// The leading one first, also where only `plane` tells it.
std::vector<PlaneEstimate> planes_of(const Window& window, const Answer& answer) {
  std::vector<PlaneEstimate> planes = answer.planes;
  if (window.planes.empty() || planes.empty()) return {};
  std::erase_if(planes, [&](const PlaneEstimate& one) { return one.number == window.leader; });
  planes.insert(planes.begin(), {window.leader, *answer.plane});
  return planes;
}

/// Of the observations in front of their cameras; who has many others is told by its plane.
double rms_of(const Window& window, const Initialization& result) {
  std::vector<double> errors = reprojection_errors_px(window, result.cameras, result.points);
  std::erase_if(errors, [](double error) { return !std::isfinite(error); });
  return root_mean_square(errors);
}

/// PnP needs four points; with fewer than these it is a guess.
constexpr int kLeastSeenPoints = 6;

}  // namespace

Initialization initialization_of(const Window& window, const Answer& given) {
  if (given.failed) return failed(*given.failed);
  Answer answer = seen_from_reference(given);
  const auto leading = std::ranges::find(answer.planes, window.leader, &PlaneEstimate::number);
  if (!answer.plane && leading != answer.planes.end()) answer.plane = leading->plane;
  const bool over_plane = answer.plane && answer.points.empty();
  if (!answer.plane) {
    if (answer.points.empty()) answer.points = triangulated(window, answer.cameras);
    answer.plane = plane_of_inliers(window, answer.points);
    if (!answer.plane) return failed("no plane was given, and none goes through its points");
  }
  if (!rescale(answer)) return failed("its numbers run over in the gauge of its plane");
  const auto points = over_plane ? on_plane(window, *answer.plane) : answer.points;
  Initialization result;
  result.plane = *answer.plane;
  result.planes = planes_of(window, answer);
  for (int i = 0; i < window.frame_count(); ++i) {
    const auto camera = answer.cameras[i] ? answer.cameras[i] : resected(window, points, i);
    if (!camera) {
      return failed(fmt::format("no camera was given of frame {}, which sees too few of its points",
                                window.start + i));
    }
    result.cameras.push_back(*camera);
  }
  if (over_plane) return with_map_points(window, std::move(result));
  result.points = points;
  result.rms_px = rms_of(window, result);
  return trusted(window, std::move(result));
}

std::vector<MapPoint> triangulated(const Window& window,
                                   std::span<const std::optional<Pose>> given) {
  const Eigen::Matrix3d K_inverse = window.K.inverse();
  std::vector<MapPoint> points;
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[0][j]) continue;
    std::vector<Pose> cameras;
    Eigen::Matrix3Xd rays(3, window.frame_count());
    for (int i = 0; i < window.frame_count(); ++i) {
      if (!given[i] || !window.inlier[i][j]) continue;
      rays.col(std::ssize(cameras)) = K_inverse * window.points_px[i].col(j).homogeneous();
      cameras.push_back(*given[i]);
    }
    if (cameras.size() < 2) continue;
    const auto point = triangulate(cameras, rays.leftCols(std::ssize(cameras)));
    if (point) points.push_back({j, *point});
  }
  return points;
}

std::optional<Pose> resected(const Window& window, const std::vector<MapPoint>& points, int frame) {
  Eigen::Matrix3Xd positions(3, std::ssize(points));
  Eigen::Matrix2Xd pixels(2, std::ssize(points));
  int count = 0;
  for (const MapPoint& point : points) {
    if (!window.points_px[frame].col(point.track).allFinite()) continue;
    positions.col(count) = point.position;
    pixels.col(count++) = window.points_px[frame].col(point.track);
  }
  if (count < kLeastSeenPoints) return std::nullopt;
  const auto found = resect_camera(positions.leftCols(count), pixels.leftCols(count), window.K);
  return found ? std::optional(found->pose) : std::nullopt;
}

}  // namespace gpo
