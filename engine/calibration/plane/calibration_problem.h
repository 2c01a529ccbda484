// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_views.h"
#include "engine/calibration/plane/plane_unknowns.h"

#include <memory>
#include <vector>

#include <ceres/ceres.h>
#include <ceres/rotation.h>

namespace gpo {

/// Where the lens puts a plane's point, less where it was seen [px] (engine/method.md, 19).
class ObservationError {
 public:
  ObservationError(const PlaneView& view, Eigen::Index column, int width, int height)
      : raw_px_(view.raw_px.col(column)),
        read_px_(((raw_px_.y() + 0.5) / height - 0.5) * view.flow_px.col(column)),
        width_(width),
        height_(height) {}

  template <typename T>
  bool operator()(const T* lens, const T* pose, const T* point, T* error) const {
    using std::exp;
    T p[3];
    ceres::AngleAxisRotatePoint(pose, point, p);
    const T z = p[2] + pose[5];
    if (!(z > T(1e-6))) return false;
    const T x = (p[0] + pose[3]) / z;
    const T y = (p[1] + pose[4]) / z;
    const T r2 = x * x + y * y;
    const T bend = T(1) + r2 * (lens[4] + r2 * lens[5]);
    const T fx = width_ * exp(lens[0] - 0.5 * lens[1]);
    const T fy = width_ * exp(lens[0] + 0.5 * lens[1]);
    const T across = 2.0 * x * y;
    const T x_bent = bend * x + lens[6] * across + lens[7] * (r2 + 2.0 * x * x);
    const T y_bent = bend * y + lens[6] * (r2 + 2.0 * y * y) + lens[7] * across;
    error[0] = fx * x_bent + 0.5 * (width_ - 1) + width_ * lens[2] + lens[kReadout] * read_px_.x() -
               raw_px_.x();
    error[1] = fy * y_bent + 0.5 * (height_ - 1) + width_ * lens[3] +
               lens[kReadout] * read_px_.y() - raw_px_.y();
    return true;
  }

 private:
  Eigen::Vector2d raw_px_;
  Eigen::Vector2d read_px_;  ///< how far it goes until its row is read, by a readout of 1
  double width_;
  double height_;
};

/// What a row of the problem's Jacobian is about.
struct ResidualSource {
  int plane = -1;  ///< -1: a prior, or the gyroscope
  int view = 0;
  int point = 0;
  int rows = 2;
  double sigma_px = 0;  ///< of a prior's rows: what they weigh as
};

/// The least squares of `adjust`, over the unknowns of an adjustment that it changes in place.
class CalibrationProblem {
 public:
  CalibrationProblem(const std::vector<ObservedPlane>& planes,
                     const GyroRotations& gyro,
                     int width,
                     int height,
                     const LensPrior& prior,
                     const PlaneAdjustmentOptions& options,
                     Adjustment& unknowns);

  void solve();

  const std::vector<ResidualSource>& sources() const { return sources_; }
  /// Errors and Jacobian as the loss weighs them; the lens' unknowns come first.
  void evaluate(std::vector<double>& residuals, ceres::CRSMatrix& jacobian);

 private:
  void add_observations(const std::vector<ObservedPlane>& planes, int width, int height);
  void add_rotations(const std::vector<ObservedPlane>& planes, const GyroRotations& gyro);
  void hold_gauge(const std::vector<ObservedPlane>& planes);
  void add_heights();

  const PlaneAdjustmentOptions& options_;
  Adjustment& unknowns_;
  ceres::Problem problem_;
  std::vector<ResidualSource> sources_;
  std::vector<double*> free_blocks_;
};

}  // namespace gpo
