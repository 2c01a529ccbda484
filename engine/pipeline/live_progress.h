// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"
#include "engine/live.h"
#include "engine/planes/inliers.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>

#include <Eigen/Core>

namespace gpo {

/// Estimates the camera's translation from its reference frame by one homography, in a fraction of
/// a millisecond: without rotations, a normal or other frames.
class Travel {
 public:
  Travel(const Camera& camera, const RansacOptions& ransac, const Frame& reference);

  struct Step {
    int seen = 0;  ///< tracks of the reference frame that are seen
    /// |tau| [distance of the plane with most tracks]; nullopt if they have no homography.
    std::optional<double> tau;
  };
  Step to(const Frame& frame) const;

 private:
  Camera camera_;
  RansacOptions ransac_;
  Eigen::Matrix3d K_;
  std::unordered_map<std::int64_t, Eigen::Vector2d> reference_px_;  ///< undistorted, by track
};

/// Result of a window that was solved live.
struct LiveOutcome {
  std::shared_ptr<const WindowResult> result;  ///< null if there was an error
  std::string error = {};

  bool is_ready() const { return result && result->is_ready(); }
  std::string why_not_ready() const { return result ? result->why_not_ready() : error; }
};

/// The answer so far, from the windows solved one after the other.
struct LiveProgress {
  LiveStatus status = {};
  std::shared_ptr<const WindowResult> first = nullptr;  ///< the answer that was ready first

  /// Returns whether a longer window may be ready or improve the answer.
  bool worth_solving(int length) const;
  void take(int length, LiveOutcome outcome);
};

}  // namespace gpo
