// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"

#include <array>

#include <opencv2/core.hpp>

namespace gpo::test {

/// A floor and a wall with textures of their own, which meet in front of a camera that moves
/// sideways and turns. World: the reference camera's axes.
class CornerScene {
 public:
  static constexpr int kFrames = 20;

  CornerScene();

  const Camera& camera() const { return camera_; }
  /// CV_8UC1, with noise.
  cv::Mat gray(int frame) const;
  /// The plane that a raw pixel of the reference picture shows: 0 the floor, 1 the wall.
  int plane_at(const Eigen::Vector2d& raw_px) const;
  /// Where a raw pixel of the reference picture is in another one.
  Eigen::Vector2d moved(const Eigen::Vector2d& raw_px, int frame) const;

 private:
  /// normal . X = distance, and two axes in it.
  struct Surface {
    Eigen::Vector3d normal;
    double distance;
    Eigen::Vector3d along, across;
    cv::Mat texture;
  };

  Camera camera_;
  std::array<Surface, 2> surfaces_;
  cv::Mat rays_;  ///< CV_64FC2, of every pixel at depth 1
};

}  // namespace gpo::test
