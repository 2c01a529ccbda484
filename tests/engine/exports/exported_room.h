// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"

#include <random>

#include <opencv2/imgproc.hpp>

namespace gpo::test {

inline const Plane kRoomFloor{Eigen::Vector3d(0, -0.6, -0.8), 1};
inline const Plane kRoomWall{Eigen::Vector3d(-0.8, 0, -0.6), 1.5};
inline constexpr double kRoomSquare = 0.1;  ///< side of a square of the floor

inline Eigen::Vector3d on_room_plane(const Eigen::Vector3d& ray, const Plane& plane) {
  return ray * (-plane.distance / plane.normal.dot(ray));
}

/// Gray of the floor, a chessboard along x of the camera.
inline int floor_gray(const Eigen::Vector3d& point) {
  const Eigen::Vector3d y = kRoomFloor.normal.cross(Eigen::Vector3d::UnitX());
  const auto cell = [](double at) { return static_cast<int>(std::floor(at / kRoomSquare)); };
  return (cell(point.x()) + cell(y.dot(point))) % 2 == 0 ? 60 : 200;
}

/// The reference image: the floor's chessboard everywhere, darker to the right of the middle.
inline cv::Mat room_image(const Camera& camera) {
  cv::Mat image(camera.height, camera.width, CV_8UC3, cv::Scalar::all(0));
  const Eigen::Matrix3d K_inverse = intrinsic_matrix(camera).inverse();
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const Eigen::Vector3d ray = K_inverse * undistort(camera, {x, y}).homogeneous();
      if (ray.allFinite() && kRoomFloor.normal.dot(ray) < 0)
        image.at<cv::Vec3b>(y, x) =
            cv::Vec3b::all(static_cast<unsigned char>(floor_gray(on_room_plane(ray, kRoomFloor))));
    }
  return image;
}

/// A result without a recording on disk: a floor in the left half of the reference image and a wall
/// in the right half, noise of 0.3 px in all frames but the first, one outlier, and images.
inline Inspection exported_room(const Camera& camera, int frames = 4) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise_px(0, 0.3);
  auto recording = std::make_shared<Recording>();
  auto tracks = std::make_shared<Tracks>();
  auto window = std::make_shared<Window>();
  auto result = std::make_shared<Initialization>();
  recording->name = "room";
  recording->camera = camera;
  recording->images = std::make_shared<FrameCache>(
      frames, [image = room_image(camera)](int /*index*/) { return image; });
  result->ok = true;
  result->plane = kRoomFloor;
  result->planes = {{.number = 0, .plane = kRoomFloor}, {.number = 1, .plane = kRoomWall}};
  window->K = intrinsic_matrix(camera);
  window->planes.resize(2);
  std::vector<Eigen::Vector2d> pixels;
  for (int y = camera.height / 4; y < camera.height - 10; y += 30)
    for (int x = 15; x < camera.width - 10; x += 30) pixels.emplace_back(x, y);
  const auto count = std::ssize(pixels);
  window->points_px.assign(frames, Eigen::Matrix2Xd(2, count));
  window->inlier.assign(frames, std::vector<bool>(count));
  for (WindowPlane& plane : window->planes) plane.inlier = window->inlier;
  tracks->raw_px = window->points_px;
  for (int i = 0; i < frames; ++i) {
    recording->timestamps_ns.push_back(1'000'000'000 + 33'000'000 * std::int64_t{i});
    result->cameras.push_back(
        {so3_exp({0.01 * i, -0.02 * i, 0.005 * i}), {0.05 * i, 0.02 * i, 0.01 * i * i}});
  }
  window->timestamps_ns = recording->timestamps_ns;
  for (int j = 0; j < count; ++j) {
    const int k = pixels[j].x() < camera.width / 2.0 ? 0 : 1;
    const bool outlier = j == 0;
    const Eigen::Vector3d point =
        on_room_plane(window->K.inverse() * undistort(camera, pixels[j]).homogeneous(),
                      k == 0 ? kRoomFloor : kRoomWall);
    tracks->ids.push_back(100 + j);
    if (!outlier) window->planes[k].tracks.push_back(j);
    if (!outlier && k == 0) result->points.push_back({j, point});
    for (int i = 0; i < frames; ++i) {
      Eigen::Vector2d seen = project(camera, to_camera(result->cameras[i], point));
      if (i > 0) seen += Eigen::Vector2d(noise_px(random), noise_px(random));
      if (i > 0 && outlier) seen.x() += 20;
      tracks->raw_px[i].col(j) = seen;
      window->points_px[i].col(j) = undistort(camera, seen);
      window->planes[k].inlier[i][j] = !outlier && window->points_px[i].col(j).allFinite();
    }
  }
  window->inlier = window->planes[0].inlier;
  Inspection room;
  room.recording = recording;
  room.tracks = tracks;
  room.window = window;
  room.initialization = result;
  room.settings.frames = frames;
  room.cube = anchor_on_plane(kRoomFloor, Pose{}, {-0.1, 0.3, 1});
  room.other_cubes = place_other_cubes(room);
  return room;
}

}  // namespace gpo::test
