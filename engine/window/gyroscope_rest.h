// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Samples between which the rates hardly vary.
struct QuietSpan {
  std::size_t begin = 0, end = 0;
  Eigen::Vector3d mean_rad_s = Eigen::Vector3d::Zero();
  double sigma_rad_s = 0;  ///< standard deviation of a sample, largest axis
};

/// Returns the spans of at least 0.4 s in which the rates stay constant to about 0.02 rad/s, the
/// longest first. The camera may be at rest in them, or turn slowly and evenly.
std::vector<QuietSpan> quiet_spans(const Gyroscope& gyroscope);

/// Measurements of sensors that vary by their own noise only.
struct SensorsAtRest {
  Eigen::Vector3d mean_rad_s;
  std::optional<Eigen::Vector3d> mean_m_s2;  ///< nullopt without an accelerometer that works
  double most_m_s2 = 0;                      ///< accelerations that its noise may hide
};

/// Returns the means over the samples `begin` to `end` if all of them vary by white noise of the
/// size of a sensor's; else nullopt. A sensor without any noise is broken, and determines nothing.
/// An even rotation is no variation of rates; about the vertical not of accelerations either.
std::optional<SensorsAtRest> sensors_at_rest(const Gyroscope& gyroscope,
                                             std::size_t begin,
                                             std::size_t end);

/// Standard deviation of the bias for the whole recording if an interval at rest determines it,
/// each axis, besides the interval's own: the bias changes with temperature
/// (`kStatedBiasSigma_rad_s`) and with the direction of gravity (up to 0.1 deg/s per g). In 22 s of
/// EuRoC's room it changes by 0.0004 rad/s.
inline constexpr double kRestBiasSigma_rad_s = kStatedBiasSigma_rad_s;

/// Largest plausible distance of a bias from its prior [standard deviations].
inline constexpr double kMostBiasSigmas = 6;

/// Returns the distance of a bias from the gyroscope's own in the latter's standard deviations.
double sigmas_from_prior(const Gyroscope& gyroscope, const Eigen::Vector3d& bias_rad_s);

}  // namespace gpo
