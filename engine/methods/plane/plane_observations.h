// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/window.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

inline constexpr std::size_t kKernelWidth = 4;  ///< observations a step of the kernels takes

inline constexpr int kMostOtherPlanes = 6;  ///< beside the leading one

/// The inliers of one frame, a structure of arrays for the vector units. Padded with copies of the
/// first one, masked, to whole vectors.
struct FrameObservations {
  int count = 0;                        ///< inliers
  std::vector<double> ray_x;            ///< K^-1 p_1 = (ray_x, ray_y, 1)
  std::vector<double> ray_y;            ///< [-]
  std::vector<double> u;                ///< seen in the frame, from the principal point on [px]
  std::vector<double> v;                ///< [px]
  std::vector<double> mask;             ///< square root of the weight, 1; of the padding 0
  std::vector<int> track;               ///< column of each in the window
  std::vector<Eigen::Matrix2d> weight;  ///< one an inlier; empty: `mask` has it
};

/// What the optimizations over a plane see of a window.
struct PlaneObservations {
  double fx = 1, fy = 1;                  ///< [px]
  std::vector<FrameObservations> frames;  ///< one a frame; that of the reference frame is empty
  std::vector<std::vector<FrameObservations>> others = {};  ///< the same of each further plane

  int count() const;
};

/// Every inlier observation of the leading plane, and of the others with these numbers, of weight
/// one.
PlaneObservations plane_observations(const Window& window, std::span<const int> others = {});

/// The inliers of one frame; empty of the reference frame.
FrameObservations frame_observations(const Window& window, int frame);

}  // namespace gpo
