// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/results/result_poses.h"

namespace gpo {

/// The cameras of a window's frames in the world of a result.
struct ResultCameras {
  std::vector<std::optional<Pose>> cameras = {};  ///< one per frame; nullopt if it has none
  int interpolated = 0;                           ///< frames between two poses
  int in_gaps = 0;           ///< frames without a camera between poses that are too far apart
  double longest_gap_s = 0;  ///< between such poses
};

/// Matches frames and poses: by name or number, or by time with interpolation between poses at most
/// 1.5 frame periods apart, and over longer gaps only within a tenth of a period of a pose.
/// `offset_s` is added to the times of the result. Throws InputError if T_BS is unknown for body
/// poses, or two images have a frame's name.
ResultCameras found_cameras(const ResultPoses& result,
                            PosedFrame frame,
                            const Window& window,
                            const Sources& sources,
                            double offset_s);

/// Returns the camera in the frame of the poses. Throws InputError if it is unknown.
Pose pose_of_camera(PosedFrame frame, const std::optional<Pose>& T_body_camera);

struct ResultCoverage {
  int count = 0;
  int first = 0;  ///< frames of the window
  int last = 0;
};
ResultCoverage coverage_of(const std::vector<std::optional<Pose>>& cameras);

/// Returns "; it is from 1.000 to 2.000 s, the window from ..." for messages.
std::string span_text(const ResultPoses& poses, const Window& window);

/// Returns the median angle between the rotations of cameras and those of the window [deg].
double rotation_misfit_deg(const std::vector<std::optional<Pose>>& cameras, const Window& window);

/// Returns the plane, in the map's world, through the map's points (3 x n) that the reference
/// camera sees within 2 deg of an inlier track, by RANSAC with a fixed seed; nullopt for fewer than
/// 10 such points. The map may be larger than the window and have other planes.
std::optional<Plane> plane_in_view(const Eigen::Matrix3Xd& points,
                                   const Pose& reference,
                                   const Window& window);

}  // namespace gpo
