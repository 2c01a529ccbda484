// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"

#include <array>

#include <opencv2/core.hpp>

namespace gpo::test {

/// A textured floor and wall that meet in front of a camera, which moves sideways and rotates.
/// World: the reference camera.
class CornerScene {
 public:
  static constexpr int kFrames = 20;

  CornerScene();

  const Camera& camera() const { return camera_; }
  /// Returns an image with noise, CV_8UC1.
  cv::Mat gray(int frame) const;
  /// Returns the plane at a raw pixel of the reference image: 0 the floor, 1 the wall.
  int plane_at(const Eigen::Vector2d& raw_px) const;
  /// Returns where a raw pixel of the reference image is in another frame.
  Eigen::Vector2d moved(const Eigen::Vector2d& raw_px, int frame) const;

 private:
  Eigen::Vector3d ray_at(const Eigen::Vector2d& raw_px) const;
  /// normal . X = distance.
  struct Surface {
    Eigen::Vector3d normal;
    double distance;
    Eigen::Vector3d along, across;
    cv::Mat texture;
  };

  Camera camera_;
  std::array<Surface, 2> surfaces_;
  cv::Mat rays_;  ///< x and y of every pixel at depth 1, CV_64FC2
};

}  // namespace gpo::test
