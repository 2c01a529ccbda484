// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/patch.h"
#include "engine/window/tracks.h"

#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace gpo {

struct SearchOptions {
  double farthest_px = 5;          ///< a look is not searched farther from its prediction [px]
  double least_correlation = 0.7;  ///< zero-mean normalized, below it a look is not found [-]
  double edge = 0.25;              ///< a look is one where its slopes' squares along the weakest
                                   ///< direction have less than this share of the strongest's [-]
  double least_detail = 0.4;       ///< see `detail_along_edge` [-]
};

/// A look that is searched for again and again.
struct PatchTemplate {
  Patch patch;
  PatchNormalMatrix normal;
  Eigen::LDLT<PatchNormalMatrix> affine;      ///< of the normal matrix
  Eigen::LDLT<Eigen::Matrix4d> shift;  ///< of its part without the terms of dx and dy
  Eigen::Vector2d along_edge;          ///< a unit vector, in which its brightness changes least
  double edge;                         ///< see SearchOptions
};

PatchTemplate make_patch_template(Patch patch);

enum class MotionModel { shift, affine };

/// Where a look is found, or why not; the end's frame is 0.
struct Found {
  Warp warp = {};
  std::optional<TrackEnd> end = std::nullopt;
};

/// Searches a soft picture for a look, from `start`, whatever gain and offset the exposure has:
/// inverse compositional Gauss-Newton over the warp's center, or center and linear part
/// (engine/method.md, 15a).
Found search(const cv::Mat& smoothed,
             const PatchTemplate& patch_template,
             const Warp& start,
             MotionModel unknown,
             const SearchOptions& options = {});

/// How much of what a look shows along its edge the picture shows again (engine/method.md, 15c):
/// the picture's slopes regressed on the look's; 1: all of it. Near 0 the look is an edge with
/// noise, which correlates wherever it slides to. Nothing where a part of the look is not in the
/// picture.
std::optional<double> detail_along_edge(const cv::Mat& smoothed,
                                        const PatchTemplate& patch_template,
                                        const Warp& warp);

}  // namespace gpo
