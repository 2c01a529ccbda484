// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/plane/plane_adjustment.h"

#include "engine/calibration/plane/calibration_problem.h"

#include <cmath>
#include <limits>

namespace gpo {

Camera camera_of(const LensVector& lens, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = width * std::exp(lens[0] - 0.5 * lens[1]);
  camera.fy = width * std::exp(lens[0] + 0.5 * lens[1]);
  camera.cx = 0.5 * (width - 1) + width * lens[2];
  camera.cy = 0.5 * (height - 1) + width * lens[3];
  camera.distortion = Distortion::radial_tangential;
  camera.coefficients = {lens[4], lens[5], lens[6], lens[7]};
  return camera;
}

LensVector lens_of(const Camera& camera) {
  const auto coefficient = [&](std::size_t k) {
    const bool radial = camera.distortion == Distortion::radial_tangential;
    return radial && k < camera.coefficients.size() ? camera.coefficients[k] : 0.0;
  };
  LensVector lens;
  lens << 0.5 * std::log(camera.fx * camera.fy / camera.width / camera.width),
      std::log(camera.fy / camera.fx), (camera.cx - 0.5 * (camera.width - 1)) / camera.width,
      (camera.cy - 0.5 * (camera.height - 1)) / camera.width, coefficient(0), coefficient(1),
      coefficient(2), coefficient(3), 0;
  return lens;
}

Adjustment adjust(const std::vector<ObservedPlane>& planes,
                  const GyroRotations& gyro,
                  int width,
                  int height,
                  const Adjustment& start,
                  const LensPrior& prior,
                  const PlaneAdjustmentOptions& options) {
  Adjustment result = start;
  CalibrationProblem problem(planes, gyro, width, height, prior, options, result);
  problem.solve();
  return result;
}

ViewErrors view_errors(const std::vector<ObservedPlane>& planes,
                         int width,
                         int height,
                         const Adjustment& adjustment) {
  ViewErrors errors(planes.size());
  for (std::size_t p = 0; p < planes.size(); ++p) {
    for (std::size_t i = 0; i < planes[p].views.size(); ++i) {
      const PlaneView& view = planes[p].views[i];
      Eigen::VectorXd lengths(view.raw_px.cols());
      for (Eigen::Index k = 0; k < lengths.size(); ++k) {
        const ObservationError error(view, k, width, height);
        Eigen::Vector2d e;
        const bool in_front = error(adjustment.lens.data(),
                                    adjustment.planes[p].poses[i].data(),
                                    adjustment.planes[p].points.col(view.points[k]).data(),
                                    e.data());
        lengths[k] = in_front ? e.norm() : std::numeric_limits<double>::infinity();
      }
      errors[p].push_back(std::move(lengths));
    }
  }
  return errors;
}

}  // namespace gpo
