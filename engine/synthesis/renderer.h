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

/// Directions in camera axes within an angle of less than 90 deg from an axis.
struct Cone {
  Eigen::Vector3d axis;  ///< unit vector
  double cosine;         ///< cosine of the angle
  double sine;
};

/// Rays of a camera's image: samples x samples a pixel, on a regular grid around the pixel's
/// center, through the exact lens model. Computed once for all frames.
struct RayMap {
  int width = 0;
  int height = 0;
  int samples = 1;
  /// (x/z, y/z) in camera axes, by pixel and sample; NaN beyond the lens model's valid radius.
  std::vector<Eigen::Vector2f> rays;
  /// Cones around the rays of each span of pixels, row by row, which share candidates; nullopt
  /// beyond the lens model's valid radius.
  static constexpr int kSpan = 16;
  std::vector<std::optional<Cone>> cones;

  int spans() const { return (width + kSpan - 1) / kSpan; }  ///< per row
};
RayMap make_ray_map(const Camera& camera, int samples, int threads);

/// Light on the image, CV_32FC3 in gray levels, before lens blur and noise. Sample k of each pixel
/// is seen from poses[k % size]: poses over the exposure make motion blur.
cv::Mat render(const Scene& scene, const RayMap& map, const std::vector<Pose>& poses, int threads);

/// The same with poses for each row, or for each column (rolling shutter).
using RowPoses = std::function<std::vector<Pose>(int row)>;
cv::Mat render_rows(const Scene& scene, const RayMap& map, const RowPoses& poses, int threads);
cv::Mat render_columns(const Scene& scene, const RayMap& map, const RowPoses& poses, int threads);

/// Adds lens blur, vignette, gain and noise: CV_8UC3. The same for equal seeds and any threads.
cv::Mat expose(const cv::Mat& light,
               const ImageRecipe& image,
               double gain,
               std::uint64_t seed,
               int threads);

}  // namespace gpo
