// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/plane.h"
#include "engine/geometry/pose.h"
#include "engine/geometry/transfer.h"
#include "engine/methods/plane/plane_kernel.h"
#include "engine/window/window.h"

#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// A plane m.P + 1 = 0 other than the main plane.
struct OtherPlane {
  int number = 0;                                 ///< index in the window
  Eigen::Vector3d m = -Eigen::Vector3d::UnitZ();  ///< n / d [1 / distance of the main plane]
};

/// State of an optimization over planes: world = reference camera, distance 1 of the main plane.
/// (n, tau) and (-n, -tau) give the same images; `facing` selects the visible one.
struct PlaneMotion {
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();
  std::vector<OtherPlane> others = {};
  std::vector<Eigen::Vector3d> tau;                      ///< one per frame, -p_wc
  std::vector<Eigen::Matrix3d> R_wc;                     ///< one per frame
  Eigen::Vector3d bias_rad_s = Eigen::Vector3d::Zero();  ///< if the rotations depend on it
  /// Added to the offset of the gyroscope's clock, if the rotations depend on it.
  double time_offset_correction_s = 0;
  /// Integrated noise, one per frame: the corrected rotation is multiplied by exp(this). Empty if
  /// the gyroscope noise is not an unknown.
  std::vector<Eigen::Vector3d> gyro_noise_rad = {};
};

/// A solution with the data that it was computed from.
struct SolvedPlanes {
  const Window& window;
  const PlaneObservations& observations;
  const PlaneMotion& motion;

  int frame_count() const { return static_cast<int>(motion.tau.size()); }
};

/// Returns the paper's start: the window's rotations, zero translations, normal along z.
PlaneMotion motion_without_translation(const Window& window);
PlaneMotion motion_of(const Plane& plane, std::span<const Pose> cameras);

/// Returns the motion with the sign that puts most inliers in front of the reference camera.
PlaneMotion facing(const Window& window, PlaneMotion motion);

/// Returns the first-order correction phi of a gyroscope rotation, R_wc exp(phi), for the motion's
/// bias and time offset.
Eigen::Vector3d gyro_correction_rad(const Window& window, int frame, const PlaneMotion& motion);
/// Returns the gyroscope's R_wc of a frame corrected by the motion's bias, time offset and noise.
Eigen::Matrix3d gyro_rotation(const Window& window, int frame, const PlaneMotion& motion);
/// Returns the standard deviation of the integrated noise since the reference frame, each axis
/// [rad].
double gyro_noise_sigma_rad(const Window& window, int frame);

/// Returns the linearization point of a frame's errors on the main plane (0) or a further one, for
/// which m = n / d replaces the normal and the tangents are those of n times |m|.
FrameState frame_state(const PlaneObservations& observations,
                       const PlaneMotion& motion,
                       int frame,
                       int plane = 0);

/// Returns the normal after a step along its `normal_tangents`.
Eigen::Vector3d moved_normal(const Eigen::Vector3d& normal, const Eigen::Vector2d& u_rad);

/// Unknowns besides the normal and the translations.
struct PlaneUnknowns {
  /// bias: needs the window's `gyro`. free: three more unknowns per frame.
  RotationModel rotations = RotationModel::known;
  double sigma_px = 0.5;  ///< noise of a coordinate, the weight of the priors
  /// With `bias`: the gyroscope's integrated noise, three more unknowns per frame, with a prior
  /// that is independent between frames (engine/method.md, eq. 6b).
  bool gyro_noise = false;
};

/// Returns the weight of a prior with standard deviation `sigma` relative to the pixel noise.
inline double prior_weight(double sigma_px, double sigma) {
  const double ratio = sigma_px / sigma;
  return ratio * ratio;
}

inline constexpr int kMostShared = 2 + 3 * kMostOtherPlanes + 4;

/// Order of the unknowns that all frames share: normal of the main plane (2), normal and
/// log(1 / d) of each further plane (3), gyroscope bias (3) and time offset (1).
struct UnknownsLayout {
  int others = 0;
  int gyro = 0;  ///< 0, 3 or 4
  static int of_plane(int plane) { return plane == 0 ? 0 : 3 * plane - 1; }
  static int size_of_plane(int plane) { return plane == 0 ? 2 : 3; }
  int of_gyro() const { return 2 + 3 * others; }
  /// Appends the number of unknowns of each plane.
  void add_plane_sizes(std::vector<int>& sizes) const {
    for (int plane = 0; plane <= others; ++plane) sizes.push_back(size_of_plane(plane));
  }
  int size() const { return of_gyro() + gyro; }
};

/// Returns the number of the gyroscope's unknowns: 3 with an unknown bias, 4 also with an unknown
/// time offset, else 0.
int gyro_unknowns(const Window& window, RotationModel rotations);

using GyroColumns = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 4>;
/// d(u, phi, t) of a frame's kernel / d(unknowns of one plane, gyroscope unknowns).
using PlaneColumns = Eigen::Matrix<double, 8, Eigen::Dynamic, 0, 8, 7>;

/// Returns dphi / d(gyroscope unknowns) of a frame; `unknowns` is their number.
GyroColumns gyro_columns(const Window& window, const PlaneMotion& motion, int frame, int unknowns);

/// Gyroscope unknowns: bias and time offset.
using GyroVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1>;
/// Returns the standard deviations of the priors of the gyroscope's unknowns.
GyroVector gyro_prior_sigmas(const Window& window, int unknowns);
/// Returns the differences of the gyroscope's unknowns from the means of their priors.
GyroVector gyro_prior_errors(const Window& window, int unknowns, const PlaneMotion& motion);

/// Moves planes, bias and time offset by a step of the unknowns that all frames share.
void move_shared(const UnknownsLayout& layout,
                 const Eigen::Ref<const Eigen::VectorXd>& step,
                 PlaneMotion& motion);
/// Moves a frame by a step t, or (phi, t), of its own unknowns, after the shared ones. phi changes
/// the gyroscope's noise if the motion has one. `gyro`: number of the gyroscope's unknowns.
void move_frame(const Window& window,
                int gyro,
                int frame,
                const Eigen::Ref<const Eigen::VectorXd>& step,
                PlaneMotion& motion);

/// Scaling m of a further plane, dm = m ds, has the effect of t = tau ds, because t is multiplied
/// by m.x_1 (engine/method.md, eq. 7b).
PlaneColumns plane_columns(int plane, const Eigen::Vector3d& tau_c, const GyroColumns& gyro);

/// An optimization over the planes of a window.
struct PlaneTask {
  const Window& window;
  const PlaneObservations& observations;
  PlaneUnknowns unknowns = {};
};

}  // namespace gpo
