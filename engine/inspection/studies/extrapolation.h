// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspector.h"

namespace gpo {

/// Least number of points of the planes from which a camera is located.
inline constexpr int kLeastLocatingPoints = 8;

/// A camera after the window, located by PnP from the points of the window's planes.
struct ExtrapolatedCamera {
  int frame = 0;  ///< counts in the recording
  std::int64_t timestamp_ns = 0;
  Pose pose;             ///< in the estimate's world
  int points = 0;        ///< points of the planes that agree within the window's threshold
  double median_px = 0;  ///< median reprojection error of the points seen in the frame
};

/// Cameras of the frames right after a window. The window's result does not depend on them. They
/// have no uncertainty, because planes and points are held as they were estimated. Immutable.
struct Extrapolation {
  std::shared_ptr<const Inspection> inspection;  ///< the window
  std::vector<ExtrapolatedCamera> cameras = {};  ///< consecutive frames after it
  std::string end = {};  ///< why there are no more cameras, one line; empty if none were requested
  /// The inspection as if its window had these frames, too, for views: tracks, inliers, cameras and
  /// truth; `Inspection::extrapolated_from` is set. Null without cameras.
  std::shared_ptr<const Inspection> extended = {};

  int last_frame() const { return cameras.empty() ? -1 : cameras.back().frame; }
};

/// Locates the cameras of up to `frames` frames after a window that is ok, as long as at least
/// `kLeastLocatingPoints` points of its planes are seen. The tracks are the recording's own, else
/// those of the built-in front end, followed on from the window. Returns null if stopped.
std::shared_ptr<const Extrapolation> extrapolate(
    const std::shared_ptr<const Inspection>& inspection,
    int frames,
    const std::stop_token& stop = {},
    const Progress& progress = {});

}  // namespace gpo
