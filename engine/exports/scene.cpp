// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/exports/scene.h"

#include "engine/base/error.h"
#include "engine/geometry/statistics.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gpo {
namespace {

using Eigen::Matrix3d, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kMargin = 0.1;  // around the points of a plane, of their extent

/// Returns whether a frame sees the point, as an inlier of its plane if it is on one.
bool is_seen(const Window& window, const ScenePoint& point, int frame) {
  if (!point.plane) return window.points_px[frame].col(point.track).allFinite();
  return *point.plane == window.leader ? window.inlier[frame][point.track]
                                       : window.planes[*point.plane].inlier[frame][point.track];
}

/// Returns the camera of a frame in the unit of the export.
RollingCamera exported_camera(const ExportScene& scene, int frame) {
  RollingCamera camera = rolling_camera(scene.inspection, frame);
  camera.motion = scaled(camera.motion, scene.world.T_world_reference.scale);
  return camera;
}

/// Returns the plane of a track of the result, as its inlier or that of another plane.
std::optional<int> plane_of_point(const Window& window, int track) {
  return window.is_inlier_track(track) ? std::optional(window.leader) : window.plane_of(track);
}

Rgb color_at(const cv::Mat& bgr, const Vector2d& raw_px) {
  if (bgr.empty() || !raw_px.allFinite()) return ScenePoint{}.color;
  const int x = std::clamp(static_cast<int>(std::lround(raw_px.x())), 0, bgr.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(raw_px.y())), 0, bgr.rows - 1);
  const auto& pixel = bgr.at<cv::Vec3b>(y, x);
  return {pixel[2], pixel[1], pixel[0]};
}

/// Sets the frames that see a point, and its reprojection error.
void observe(const ExportScene& scene, ScenePoint& point) {
  const Window& window = *scene.inspection.window;
  double squares = 0;
  for (int i = 0; i < window.frame_count(); ++i) {
    if (!is_seen(window, point, i)) continue;
    const Vector2d raw_px = scene.inspection.tracks->raw_px[i].col(point.track);
    const Pose at_row = scene.cameras[i] * pose_at_row(exported_camera(scene, i), raw_px);
    const Vector3d seen = window.K * to_camera(at_row, point.position);
    if (!(seen.z() > 0)) continue;
    squares += (seen.hnormalized() - window.points_px[i].col(point.track)).squaredNorm();
    point.frames.push_back(i);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(point.frames.size(), 1));
  point.rms_px = std::sqrt(squares / count);
}

/// Adds the points of tracks that have none yet.
void add_points(ExportScene& scene, const std::vector<MapPoint>& points, const cv::Mat& image) {
  std::set<int> known;
  for (const ScenePoint& point : scene.points) known.insert(point.track);
  for (const MapPoint& found : points) {
    if (known.contains(found.track)) continue;
    ScenePoint point;
    point.track = found.track;
    point.plane = plane_of_point(*scene.inspection.window, found.track);
    point.position = scene.world.T_world_reference * found.position;
    point.color = color_at(image, scene.inspection.tracks->raw_px[0].col(found.track));
    observe(scene, point);
    scene.points.push_back(std::move(point));
  }
}

const SceneCube* cube_on(const ExportScene& scene, int plane) {
  const auto found = std::ranges::find(scene.cubes, plane, &SceneCube::plane);
  return found == scene.cubes.end() ? nullptr : &*found;
}

/// Adds a plane with the usual extent of its points and its cube. `plane`: in the estimate's world.
void add_plane(ExportScene& scene, int number, const Plane& plane) {
  const Similarity& T = scene.world.T_world_reference;
  ScenePlane added{.number = number,
                   .title = plane_title(scene.inspection, number),
                   .normal = T.R_ab * plane.normal,
                   .rgb = plane_color(number)};
  const SceneCube* cube = cube_on(scene, number);
  const Vector3d rows =
      cube != nullptr ? Vector3d(cube->axes.col(0)) : Vector3d(scene.cameras.front().R_wc.col(0));
  Vector3d x = rows - added.normal.dot(rows) * added.normal;
  if (x.norm() < 0.1) x = added.normal.unitOrthogonal();
  x.normalize();
  const Vector3d y = added.normal.cross(x);
  const Vector3d foot = T * Vector3d(-plane.distance * plane.normal);
  std::vector<double> xs, ys;
  for (const ScenePoint& point : scene.points) {
    if (point.plane != number) continue;
    xs.push_back(x.dot(point.position - foot));
    ys.push_back(y.dot(point.position - foot));
  }
  if (xs.empty()) return;
  std::array<double, 2> u = middle_range(std::move(xs)), v = middle_range(std::move(ys));
  for (int k = 0; cube != nullptr && k < 8; ++k) {
    const double along_x = x.dot(cube->corners[k] - foot), along_y = y.dot(cube->corners[k] - foot);
    u = {std::min(u[0], along_x), std::max(u[1], along_x)};
    v = {std::min(v[0], along_y), std::max(v[1], along_y)};
  }
  const double margin = kMargin * std::max(u[1] - u[0], v[1] - v[0]);
  const auto at = [&](double along_x, double along_y) -> Vector3d {
    return foot + along_x * x + along_y * y;
  };
  added.corners = {at(u[0] - margin, v[0] - margin),
                   at(u[1] + margin, v[0] - margin),
                   at(u[1] + margin, v[1] + margin),
                   at(u[0] - margin, v[1] + margin)};
  scene.planes.push_back(std::move(added));
}

void add_cubes(ExportScene& scene, double side) {
  const Inspection& inspection = scene.inspection;
  if (!inspection.cube) return;
  const double distance = inspection.initialization->plane.distance;
  if (!(side > 0)) side = default_cube_side(*inspection.cube, distance);
  const Similarity& T = scene.world.T_world_reference;
  for (const CubeAnchor& anchor : all_cubes(inspection)) {
    SceneCube cube;
    cube.plane = anchor.plane.value_or(inspection.window->leader);
    const auto corners = cube_corners(anchor, side);
    std::ranges::transform(
        corners, cube.corners.begin(), [&](const Vector3d& corner) { return T * corner; });
    // The anchor's axes are left-handed as columns, because x and y are those of an image.
    cube.axes = T.R_ab * anchor.axes;
    if (cube.axes.determinant() < 0) cube.axes.col(1) *= -1;
    cube.center = 0.5 * (cube.corners[0] + cube.corners[7]);
    cube.side = T.scale * side;
    scene.cubes.push_back(cube);
  }
}

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
  Vector2d nowhere(-10, -10);
  const Vector3d seen = to_camera(scene.cameras.front(), point);
  if (!(seen.z() > 1e-9)) return nowhere;
  const Vector2d pixel = project(exported_camera(scene, 0), seen);
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

ExportScene export_scene(const Inspection& inspection, const ExportChoices& choices) {
  const Initialization& result = *inspection.initialization;
  if (!result.ok)
    throw InputError(
        fmt::format("{}: the initialization failed ({}), so there is no result to "
                    "export. Choose another window or method",
                    inspection.recording->name,
                    result.reason));
  ExportScene scene{inspection, export_world(inspection, choices.metric)};
  scene.cameras = estimated_path(inspection, scene.world).cameras;
  const Recording& recording = *inspection.recording;
  const int leader = inspection.window->leader;
  const cv::Mat image =
      recording.images ? recording.images->bgr(inspection.window->start) : cv::Mat();
  add_points(scene, result.points, image);
  for (const PlanePatch& patch : plane_patches(inspection)) add_points(scene, patch.points, image);
  add_cubes(scene, choices.cube_side);
  add_plane(scene, leader, result.plane);
  for (const PlaneEstimate& other : result.planes)
    if (other.number != leader) add_plane(scene, other.number, other.plane);
  const std::size_t tracks = inspection.window->track_count();
  if (tracks > scene.points.size())
    scene.left_out.push_back(counted(tracks - scene.points.size(), "track") + " without a point");
  if (image.empty()) scene.left_out.emplace_back("colors, because the recording has no images");
  return scene;
}

bool has_distortion(const Camera& camera) {
  return camera.distortion != Distortion::none &&
         (camera.distortion != Distortion::radial_tangential ||
          std::ranges::any_of(camera.coefficients, [](double k) { return k != 0; }));
}

std::string image_name(const Recording& recording, int frame) {
  if (std::ssize(recording.image_files) == recording.frame_count())
    return recording.image_files[frame].filename().string();
  return fmt::format("{}.png", recording.timestamps_ns[frame]);
}

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
