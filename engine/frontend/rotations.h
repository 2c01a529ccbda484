// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/frontend/relative_pose.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Camera rotations of a window, or the reason why there are none.
struct Rotations {
  std::vector<Eigen::Matrix3d> R_wc = {};  ///< one a frame, I in the first; empty: none
  std::string reason = "";
  RotationModel model = RotationModel::known;          ///< their uncertain parts
  std::optional<GyroSensitivity> gyro = std::nullopt;  ///< for rotations from a gyroscope
  double sigma_rad = 0;                                ///< rough, of rotations from images
  bool stopped = false;                                ///< there are none because of that
  std::string note = "";                               ///< how an ambiguity was resolved, if any
};

/// automatic: a gyroscope, calibrated if the images can; without one five-point rotations if the
/// scene has more than one plane, else averaging. raw: an uncalibrated gyroscope, else averaging.
/// averaging uses decomposed homographies; five_point and direct use all tracks.
enum class RotationSource {
  automatic,
  raw,
  gyro,
  gyro_calibrated,
  averaging,
  five_point,
  direct,
  truth
};

template <>
struct ChoiceKeys<RotationSource> {
  static constexpr const char* name = "rotations";
  static constexpr std::array keys{
      "automatic", "raw", "gyro", "gyro-calibrated", "averaging", "five-point", "direct", "truth"};
};

/// Returns whether the source integrates a gyroscope.
bool needs_gyroscope(RotationSource source);

/// Returns R_wc at each time, with the first camera as world: mid-point integration of (w - bias)
/// on SO(3), interpolated at the frame times (engine/method.md, eq. 5). Throws InputError if the
/// samples do not cover the times or leave a gap of more than five sample periods.
std::vector<Eigen::Matrix3d> gyro_rotations(const Gyroscope& gyroscope,
                                            std::span<const std::int64_t> frame_times_ns);

/// The same with derivatives by bias and clock offset and the gyroscope's own prior of the bias.
Rotations sensitive_gyro_rotations(const Gyroscope& gyroscope,
                                   std::span<const std::int64_t> frame_times_ns);

struct GyroBias {
  Eigen::Vector3d bias_rad_s;  ///< in the gyroscope's axes
  Eigen::Matrix3d covariance;  ///< [(rad/s)^2]
};

/// Estimates the constant bias whose integrated rotations fit the visual ones best: robust least
/// squares over the frames, with a Gaussian prior at the gyroscope's own bias (`bias_sigma_rad_s`).
/// Errors of the visual rotations are correlated through the plane's normal, so all frames together
/// weigh as one: a short or ill-conditioned window keeps the gyroscope's own bias.
GyroBias fit_gyro_bias(const Gyroscope& gyroscope,
                       std::span<const std::int64_t> frame_times_ns,
                       const Rotations& visual);

/// Integrates a gyroscope with a constant bias estimated from the window's averaged homography
/// decompositions, among which the gyroscope selects the plane. Empty, with a reason, if there are
/// no visual rotations.
Rotations calibrated_gyro_rotations(const Gyroscope& gyroscope,
                                    const Window& window,
                                    const std::stop_token& stop = {});

/// Estimates the rotations of a window's cameras from its images alone: decomposes homographies
/// between pairs of frames, selects the candidates whose plane normal agrees over the window, and
/// averages their rotations. On a plane these are far more accurate than five-point rotations
/// (`tests/engine/frontend/homography_rotations_test.cpp` measures both). Empty, with a reason, if
/// the homographies allow no consistent choice or are ambiguous, or if stopped.
Rotations averaged_rotations(const Window& window, const std::stop_token& stop = {});

/// The same, but roughly known rotations (one a frame, e.g. a gyroscope's) resolve the ambiguity.
Rotations averaged_rotations(const Window& window,
                             std::span<const Eigen::Matrix3d> R_wc_given,
                             const std::stop_token& stop = {});

struct PairRotationOptions {
  RelativeSolver solver = RelativeSolver::five_point;
  double threshold_px = 2.0;  ///< largest distance of an inlier from the epipolar geometry [px]
  std::uint64_t seed = 1;     ///< for the random samples
};

/// Estimates the rotations of a window's cameras from all its tracks, on any surface: relative
/// poses of pairs of frames by RANSAC, whose rotations are averaged (Chatterjee & Govindu). Empty,
/// with a reason, if one plane explains nearly all tracks and makes them ambiguous, if too few
/// tracks join a frame to the first one, or if stopped.
Rotations pair_rotations(const Window& window,
                         const PairRotationOptions& options,
                         const std::stop_token& stop = {});

}  // namespace gpo
