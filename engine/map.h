// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initialize.h"

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

/// The parts of a result that the map of a SLAM system starts from. World = the window's first
/// camera, unit = the leading plane's distance from it.
namespace gpo {

/// Returns the map points by the ids of their tracks; empty if the initialization failed.
std::map<std::int64_t, Eigen::Vector3d> points_by_id(const WindowResult& result);

/// Returns the ids of the tracks that are inliers of the leading plane in a frame of the window, in
/// the order of `WindowResult::ids`. Frame 0 has those that are inliers in half of the others.
std::vector<std::int64_t> inlier_ids(const WindowResult& result, int frame);

/// A joint Gaussian of the cameras, as the prior of a factor graph. The gauge is fixed: the first
/// camera is the world, with no row, and the plane's distance is 1. Errors of scale and world are
/// thus not in it.
struct PosePrior {
  std::vector<Pose> cameras;  ///< mean, one per frame of the window
  /// Six rows per camera, in the order of the frames from 1 on: the rotation phi of the true
  /// R_wc exp(phi), in the camera's axes [rad], then the error of p_wc in the world [distance of
  /// the plane].
  Eigen::MatrixXd covariance;
  /// Names of the rows: "camera 1 rotation x", ..., "camera 1 center x", ...
  std::vector<std::string> rows;
};

/// Returns the prior; nullopt if the initialization failed or its method computes none. `gpo_joint`
/// does, except for exact reference positions (`ErrorModel::transfer`) and with `Gravity::joint`.
std::optional<PosePrior> pose_prior(const WindowResult& result);

}  // namespace gpo
