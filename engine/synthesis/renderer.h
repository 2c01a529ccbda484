// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/geometry/pose.h"
#include "engine/synthesis/recipe.h"
#include "engine/synthesis/scene.h"

#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

/// Directions within an angle of an axis, less than a quarter turn; in camera axes.
struct Cone {
  Eigen::Vector3d axis;  ///< unit vector
  double cosine;         ///< of the angle
  double sine;
};

/// The rays of a camera's picture: samples x samples a pixel, on a regular grid about the pixel's
/// center, through the exact lens model. Computed once for all frames.
struct RayMap {
  int width = 0;
  int height = 0;
  int samples = 1;
  /// (x/z, y/z) in camera axes, pixel by pixel, sample by sample; NaN where the lens sees nothing.
  std::vector<Eigen::Vector2f> rays;
  /// Around the rays of each span of pixels, row by row, which share what they may meet; none where
  /// the lens sees nothing.
  static constexpr int kSpan = 16;
  std::vector<std::optional<Cone>> cones;

  int spans() const { return (width + kSpan - 1) / kSpan; }  ///< a row
};
RayMap make_ray_map(const Camera& camera, int samples, int threads);

/// The light that falls on the picture, CV_32FC3 in gray levels, without lens blur and noise.
/// Sample k of each pixel is seen from poses[k % size]: poses spread over the exposure make motion
/// blur.
cv::Mat render(const Scene& scene, const RayMap& map, const std::vector<Pose>& poses, int threads);

/// The same where each row is seen from poses of its own (rolling shutter).
using RowPoses = std::function<std::vector<Pose>(int row)>;
cv::Mat render(const Scene& scene, const RayMap& map, const RowPoses& row_poses, int threads);

/// Lens blur, vignette, gain and noise: CV_8UC3. Equal for equal seeds, whatever the threads.
cv::Mat expose(const cv::Mat& light,
               const ImageRecipe& image,
               double gain,
               std::uint64_t seed,
               int threads);

}  // namespace gpo
