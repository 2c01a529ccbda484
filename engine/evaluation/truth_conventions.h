// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/eigen_layout.h"
#include "engine/truth/truth.h"

#include <optional>
#include <span>
#include <string>

namespace gpo {

/// Ground truth whose rotations contradict those of the images, but fit them if the file is read by
/// another convention.
struct TruthConvention {
  double as_read_deg = 0;  ///< RMS difference of the rotations over the window
  double fitted_deg = 0;   ///< the same by the convention that fits
  std::string name;        ///< completes "they fit if ..."
  std::string advice;      ///< a change of the file, one sentence
  bool is_used = false;    ///< the window's rotations are those of the truth
};

/// Returns "the ground truth's rotations differ by ... if ...".
std::string sentence_of(const TruthConvention& convention);

/// Compares the rotations of the truth relative to the reference frame with `R_wc` of the images,
/// one per frame, whose standard deviation is `sigma_rad`. Returns nullopt if they agree as read,
/// if no convention fits clearly better, or if the rotations are too small to tell.
std::optional<TruthConvention> truth_convention(const WindowTruth& truth,
                                                std::span<const Eigen::Matrix3d> R_wc,
                                                double sigma_rad);

}  // namespace gpo
