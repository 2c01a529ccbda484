// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/verdict.h"
#include "engine/window/window.h"

#include <optional>

namespace gpo {

/// Of a window that is ready: least |tau| of its farthest camera [plane distance]. Largest |tau| of
/// simulated windows: below 0.0065 without parallax, above 0.042 at low parallax, above 0.24
/// elsewhere.
inline constexpr double kReadyTranslation = 0.06;

/// What a verdict rests on beside the normal's uncertainty; grows frame by frame.
class WindowEvidence {
 public:
  void add(const FrameErrors& errors);
  /// Coordinates' standard deviation, what the homographies leave of the inliers [px].
  double noise_px() const;
  /// The same of what the best rotation of each frame leaves [px].
  double rotation_rms_px() const;

 private:
  int frames_ = 0;
  double residuals_ = 0;
  double homography_squares_ = 0;
  double rotation_squares_ = 0;
};

/// Of all frames of the window.
WindowEvidence evidence_of(const Window& window);

/// Ready, weak or degenerate, by thresholds that tell simulated windows apart without an error
/// (engine/method.md, "The verdict on a window").
Verdict judged(const WindowEvidence& evidence,
               std::optional<double> normal_sigma_deg,
               double largest_translation);

}  // namespace gpo
