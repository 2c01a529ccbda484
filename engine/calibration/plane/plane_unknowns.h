// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The unknowns of a lens and its sensor, each of the order of 1: log(f / width), log(fy / fx), the
/// principal point from the picture's middle [widths], k1, k2, p1, p2, and how long it takes to
/// read a picture from the first row to the last [time from frame to frame]; negative: from below.
/// f is the geometric mean of fx and fy.
inline constexpr int kLensUnknowns = 9;
inline constexpr int kReadout = 8;
using LensVector = Eigen::Matrix<double, kLensUnknowns, 1>;
inline constexpr std::array<const char*, kLensUnknowns> kLensNames = {
    "f", "fy/fx", "cx", "cy", "k1", "k2", "p1", "p2", "readout"};

/// What is known of a lens before anything was seen, Gaussian.
struct LensPrior {
  LensVector mean = {-0.1, 0, 0, 0, 0, 0, 0, 0, 0};
  LensVector sigma = {1.0, 0.01, 0.04, 0.04, 0.3, 0.5, 0.003, 0.003, 0.5};
};

/// A plane as it is adjusted: its points (x, y, height), in the distance of the picture that it was
/// begun in, and a pose for each of its sights, x_c = exp(w) X + t, as (w, t).
struct AdjustedPlane {
  Eigen::Matrix3Xd points;
  std::vector<Eigen::Matrix<double, 6, 1>> poses;
};

struct Adjustment {
  LensVector lens = LensVector::Zero();
  std::vector<AdjustedPlane> planes;
  Eigen::Vector3d bias_change_rad_s = Eigen::Vector3d::Zero();  ///< of the gyroscope
  double cost = 0;  ///< 1/2 sum of squares, by the loss [px^2]
  bool usable = false;
};

struct PlaneAdjustmentOptions {
  double knee_px = 1;       ///< of Huber's loss, on the length of an error [px]
  double prior_px = 1;      ///< so many pixels of an error weigh as one sigma of a prior
  double noise_px = 1;      ///< the same of the heights' prior
  double height_sigma = 0;  ///< of points off their plane [distances]; 0: planes are flat
  int most_iterations = 40;
  bool holds_distortion = false;  ///< its coefficients stay as they are, and the readout
  std::stop_token stop = {};
};

}  // namespace gpo
