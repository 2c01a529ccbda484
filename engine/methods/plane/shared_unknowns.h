// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/plane/plane_motion.h"
#include "engine/methods/plane/plane_observations.h"
#include "engine/window/window.h"

#include <Eigen/Core>

namespace gpo {

/// What is optimized beside the normal and the translations.
struct PlaneUnknowns {
  /// bias: needs the window's `gyro`. free: three more unknowns a frame.
  RotationModel rotations = RotationModel::known;
  bool time_offset = false;  ///< with `bias`: the offset between the clocks, too
  double sigma_px = 0.5;     ///< noise of a coordinate, against which the priors are weighed
  /// With `bias`: three more unknowns a frame, the gyroscope's integrated noise, with a prior that
  /// takes frames as independent (engine/method.md, eq. 6b).
  bool gyro_noise = false;
};

/// Standard deviation of the offset between clocks before anything is measured [s].
inline constexpr double kTimeOffsetSigma_s = 0.02;

inline constexpr int kMostShared = 2 + 3 * kMostOtherPlanes + 4;

/// Where the unknowns that all frames share stand: the leading plane's normal (2), normal and log
/// 1 / d of each further plane (3), the gyroscope's bias (3) and time offset (1).
struct UnknownsLayout {
  int others = 0;
  int gyro = 0;  ///< 0, 3 or 4
  static int of_plane(int plane) { return plane == 0 ? 0 : 3 * plane - 1; }
  static int size_of_plane(int plane) { return plane == 0 ? 2 : 3; }
  int of_gyro() const { return 2 + 3 * others; }
  int size() const { return of_gyro() + gyro; }
};

using GyroColumns = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 4>;
/// (u, phi, t) of a frame's kernel over the unknowns of one plane, then the gyroscope's.
using PlaneColumns = Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 7>;

/// How so many of the gyroscope's unknowns turn a frame: phi = this times them.
GyroColumns gyro_columns(const Window& window, const PlaneMotion& motion, int frame, int unknowns);

/// Moving m of a further plane along itself, dm = m ds, moves the picture as t = tau ds does,
/// because what multiplies t is m.x_1 (engine/method.md, eq. 7b).
PlaneColumns plane_columns(int plane, const Eigen::Vector3d& tau_c, const GyroColumns& gyro);

}  // namespace gpo
