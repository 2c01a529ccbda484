// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/transfer.h"
#include "engine/window/window.h"

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace gpo {

inline constexpr std::size_t kKernelWidth = 4;  ///< observations per step of the kernels
inline constexpr int kMostOtherPlanes = 6;      ///< besides the main plane

/// Inliers of one frame as a structure of arrays for vector instructions. Padded to whole vectors
/// with masked copies of the first one.
struct FrameObservations {
  int count = 0;                        ///< inliers
  std::vector<double> ray_x;            ///< K^-1 p_1 = (ray_x, ray_y, 1)
  std::vector<double> ray_y;            ///< [-]
  std::vector<double> u;                ///< in the frame, relative to the principal point [px]
  std::vector<double> v;                ///< [px]
  std::vector<double> mask;             ///< square root of the weight, by default 1; padding 0
  std::vector<int> track;               ///< column in the window
  std::vector<Eigen::Matrix2d> weight;  ///< one per inlier; empty if `mask` is the weight
};

/// Observations of the main plane and of further planes.
struct PlaneObservations {
  double fx = 1, fy = 1;                  ///< [px]
  std::vector<FrameObservations> frames;  ///< one per frame; empty for the reference frame
  std::vector<std::vector<FrameObservations>> others = {};  ///< the same for each further plane

  int count() const;
  int plane_count() const { return 1 + static_cast<int>(others.size()); }
  /// Returns the frames of the main plane (0) or a further one.
  const std::vector<FrameObservations>& plane(int k) const { return k ? others[k - 1] : frames; }
  std::vector<FrameObservations>& plane(int k) { return k ? others[k - 1] : frames; }
};

/// Returns all inlier observations of the main plane and the planes `others`, with weight one.
PlaneObservations plane_observations(const Window& window, std::span<const int> others = {});

/// Returns the inliers of one frame; empty for the reference frame.
FrameObservations frame_observations(const Window& window, int frame);

/// Gauss-Newton normal equations of one frame's transfer errors (engine/method.md, eq. 7) over
/// (u, phi, t) with 2, 3 and 3 components: normal [+] tangents u, R_wc exp(phi), tau + R_wc t.
struct FrameNormals {
  Eigen::Matrix<double, 8, 8> JtJ = Eigen::Matrix<double, 8, 8>::Zero();  ///< [px^2]
  Eigen::Matrix<double, 8, 1> Jtr = Eigen::Matrix<double, 8, 1>::Zero();  ///< [px^2]
  double cost = 0;        ///< half the summed squares [px^2]
  bool in_front = false;  ///< all points in front of the camera; the rest is invalid otherwise
};

enum class Rotating { no, yes };  ///< no: the rows and columns of phi are zero

/// Returns the normal equations in one pass, with the widest instructions of the processor.
FrameNormals frame_normals(const FrameObservations& observations,
                           const FrameState& state,
                           Rotating rotating);
/// The implementations `frame_normals` selects from.
FrameNormals frame_normals_baseline(const FrameObservations& observations,
                                    const FrameState& state,
                                    Rotating rotating);
/// Requires `has_avx2_fma` (engine/base/processor.h).
FrameNormals frame_normals_avx2_fma(const FrameObservations& observations,
                                    const FrameState& state,
                                    Rotating rotating);

}  // namespace gpo
