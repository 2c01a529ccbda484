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
  double farthest_px = 5;          ///< largest distance from the prediction [px]
  double least_correlation = 0.7;  ///< of an accepted match, zero-mean normalized [-]
  double edge = 0.25;  ///< a template is an edge below this ratio of the squared slopes along its
                       ///< weakest and strongest directions [-]
  double least_detail = 0.4;  ///< see `detail_along_edge` [-]
};

/// A template prepared for repeated searches.
struct PatchTemplate {
  Patch patch;
  PatchNormalMatrix normal;
  Eigen::LDLT<PatchNormalMatrix> affine;      ///< of the normal matrix
  Eigen::LDLT<Eigen::Matrix4d> shift;  ///< of its part without the terms of dx and dy
  Eigen::Vector2d along_edge;          ///< unit vector of the weakest slope
  double edge;                         ///< see SearchOptions
};

PatchTemplate make_patch_template(Patch patch);

enum class MotionModel { shift, affine };

/// Alignment result, or why there is none; the end's frame is 0.
struct Found {
  Warp warp = {};
  std::optional<TrackEnd> end = std::nullopt;
};

/// Aligns a template with a smoothed image, starting at `start`: inverse compositional Gauss-Newton
/// over the warp's center, or center and linear part, invariant to gain and offset of the exposure
/// (engine/method.md, 15a).
Found search(const cv::Mat& smoothed,
             const PatchTemplate& patch_template,
             const Warp& start,
             MotionModel unknown,
             const SearchOptions& options = {});

/// Returns how much of a template's detail along its edge the image repeats (engine/method.md,
/// 15c): the regression of the image's slopes on the template's; 1: all of it. Near 0 the template
/// is an edge with noise, which correlates wherever it slides. Returns nullopt if a part of the
/// template is outside of the image.
std::optional<double> detail_along_edge(const cv::Mat& smoothed,
                                        const PatchTemplate& patch_template,
                                        const Warp& warp);

}  // namespace gpo
