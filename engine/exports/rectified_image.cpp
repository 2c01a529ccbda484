// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/scene.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Vector2d, Eigen::Vector3d;

constexpr double kLeastSide = 16, kMostSide = 2048;  // limits for the sides of a texture [px]

/// Size at which the nearest visible part of the plane keeps the image's resolution.
cv::Size texture_size(const ExportScene& scene, const ScenePlane& plane) {
  const Pose& camera = scene.cameras.front();
  const double focal_px = scene.inspection.window->K(0, 0);
  double nearest = std::abs(plane.normal.dot(camera.p_wc - plane.corners[0]));
  for (const ScenePoint& point : scene.points)
    if (point.plane == plane.number)
      nearest = std::max(1e-9, std::min(nearest, to_camera(camera, point.position).z()));
  const double width = (plane.corners[1] - plane.corners[0]).norm() * focal_px / nearest;
  const double height = (plane.corners[3] - plane.corners[0]).norm() * focal_px / nearest;
  const double shrink = std::min(1.0, kMostSide / std::max(width, height));
  const auto side = [&](double px) {
    return static_cast<int>(std::lround(std::max(kLeastSide, shrink * px)));
  };
  return {side(width), side(height)};
}

/// Returns the raw pixel of a point in the reference image; beyond the image if it is not seen.
Vector2d pixel_in_reference(const ExportScene& scene, const Vector3d& point) {
  const Vector2d nowhere(-10, -10);
  const Vector3d seen = to_camera(scene.cameras.front(), point);
  if (!(seen.z() > 1e-9)) return nowhere;
  const Vector2d pixel = project(scene.inspection.recording->camera, seen);
  return pixel.allFinite() ? pixel : nowhere;
}

/// Returns where the reference image shows a plane by its nearest track, 255 there, else 0. The
/// leading plane is everywhere: the other planes are in front of it, or a part of it.
cv::Mat visible_mask(const ExportScene& scene, const ScenePlane& plane, cv::Size size) {
  constexpr int kCell = 4;  // [px]
  if (plane.number == scene.inspection.window->leader) return {size, CV_8UC1, cv::Scalar(255)};
  cv::Mat cells((size.height + kCell - 1) / kCell, (size.width + kCell - 1) / kCell, CV_8UC1);
  for (int y = 0; y < cells.rows; ++y)
    for (int x = 0; x < cells.cols; ++x) {
      const Vector2d center(kCell * (x + 0.5) - 0.5, kCell * (y + 0.5) - 0.5);
      const bool shown = plane_near(scene.inspection, 0, center) == plane.number;
      cells.at<unsigned char>(y, x) = shown ? 255 : 0;
    }
  cv::Mat mask;
  cv::resize(cells, mask, {kCell * cells.cols, kCell * cells.rows}, 0, 0, cv::INTER_NEAREST);
  return mask(cv::Rect({}, size));
}

}  // namespace

cv::Mat rectified_image(const ExportScene& scene, const ScenePlane& plane) {
  const Recording& recording = *scene.inspection.recording;
  if (!recording.images) return {};
  const cv::Size size = texture_size(scene, plane);
  const Vector3d top_left = plane.corners[3];
  const Vector3d right = (plane.corners[2] - top_left) / size.width;
  const Vector3d down = (plane.corners[0] - top_left) / size.height;
  cv::Mat map(size, CV_32FC2);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const Vector2d pixel =
          pixel_in_reference(scene, top_left + (x + 0.5) * right + (y + 0.5) * down);
      map.at<cv::Vec2f>(y, x) = {static_cast<float>(pixel.x()), static_cast<float>(pixel.y())};
    }
  const cv::Mat bgr = recording.images->bgr(scene.inspection.window->start);
  cv::Mat bgra, texture;
  cv::merge(std::vector<cv::Mat>{bgr, visible_mask(scene, plane, bgr.size())}, bgra);
  cv::remap(bgra, texture, map, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(0));
  return texture;
}

}  // namespace gpo
