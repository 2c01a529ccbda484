// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/tracking/patch.h"

#include <optional>

namespace gpo {

/// Compares templates of the reference image with that image itself. Returns nullopt if the texture
/// around most of the tracks does not repeat within the largest motion of `coarse_flow`. `raw_px`
/// is 2 x tracks.
std::optional<Repetition> find_repetition(const SmoothedPyramid& reference,
                                          const Eigen::Matrix2Xd& raw_px);

struct RepeatedFlow {
  Eigen::Matrix2Xd px;  ///< 2 x tracks
  double margin;        ///< see Repetition
};

/// Estimates the motion of tracks like `coarse_flow` where the texture repeats: compares all
/// motions that fit about as well over the tracks together. Returns the best one, or, of those that
/// the images do not distinguish from it, the nearest to `predicted_px`. Each track stays within a
/// third of its period of the common motion. All arguments have a column or value for each track.
RepeatedFlow repeated_flow(const SmoothedPyramid& from,
                           const SmoothedPyramid& to,
                           const Eigen::Matrix2Xd& raw_px,
                           const Eigen::Matrix2Xd& predicted_px,
                           const Eigen::VectorXd& periods_px);

}  // namespace gpo
