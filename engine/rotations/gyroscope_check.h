// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/window/gyroscope.h"

#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

namespace gpo {

/// Why the rates of a gyroscope and the rotations of images disagree.
enum class GyroscopeMisfit {
  none,            ///< they agree, or it is unknown
  unit,            ///< the rates are not in rad/s
  mirrored,        ///< the axes are left-handed
  inverted,        ///< the rotation between gyroscope and camera is the wrong way round
  axes,            ///< another rotation between them fits
  clock,           ///< another offset of the clocks fits
  hardly_rotates,  ///< the images rotate, the gyroscope does not
  scale,           ///< the rates have another size
  stabilized,      ///< the images rotate less
  unrelated        ///< no rotation, clock or unit fits
};

/// Result of comparing the rates of a gyroscope with the rotations of images.
struct GyroscopeCheck {
  GyroscopeMisfit misfit = GyroscopeMisfit::none;
  double share = 1;           ///< size of the rates relative to those of the images
  double rad_s_per_unit = 1;  ///< makes the recorded rates rad/s
  /// Signed permutation, without a rotation, that makes the rates right-handed; identity: they are.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  /// Between the recorded axes and those that fit; of a mirrored gyroscope, those of a rotation
  /// that fits as well, as the rates have hardly a third component. 0 if there are none.
  double apart_deg = 0;
  double correlation = 0;  ///< correlation of the magnitudes of the rates, -1 to 1
  /// Clock offset to add to the recorded one if only the clock is wrong [s].
  std::optional<double> late_s = std::nullopt;
};

/// Compares the rates with those of the images of some windows, for the recorded axes and clock,
/// other units, other clocks (within 0.2 s) and other axes. A misfit is reported if a unit, a clock
/// (off by more than half a frame) or axes fit far better, if the gyroscope rotates far less than
/// the images, or if nothing explains the images. `sigma_rad` is the rough error of the images'
/// rotations.
GyroscopeCheck check_gyroscope_against(std::span<const ImageRotations> windows,
                                       const Gyroscope& gyroscope,
                                       double sigma_rad);

/// Returns what was seen, as "its axes are about 90 deg off"; empty for `none`.
std::string sentence_of(const GyroscopeCheck& check);

/// Returns what to do about it; empty for `none`. For a wrong unit or left-handed axes in a file of
/// comma-separated values it is the line of a shell that mends the file.
std::string advice_of(const GyroscopeCheck& check, const Gyroscope& gyroscope);

/// Returns why the windows of a recording show rates that no calibration can mend: a wrong unit or
/// left-handed axes; empty if they do not.
std::string why_wrong_rates(std::span<const ImageRotations> windows, const Gyroscope& gyroscope);

}  // namespace gpo
