// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/calibration_views.h"
#include "engine/geometry/camera.h"

#include <string>
#include <vector>

namespace gpo {

struct CalibrationOptions {
  Distortion distortion = Distortion::radial_tangential;  ///< or equidistant
  int coefficients = 4;  ///< radial_tangential: 4 (k1 k2 p1 p2), 5 or 8; equidistant: 4
};

/// Result of a calibration with a board.
struct CameraCalibration {
  bool ok = false;
  std::string reason;  ///< why there is no camera
  Camera camera;
  /// Standard deviations of fx, fy, cx, cy [px] and the coefficients [-]: the larger ones of a
  /// jackknife over ten blocks of time and of the least squares; 0 of coefficients fixed at 0.
  std::vector<double> sigmas;
  double rms_px = 0;        ///< reprojection error of the corners [raw px]
  int examined = 0;         ///< images
  int found = 0;            ///< images that show the board
  std::vector<int> frames;  ///< used
  double coverage = 0;      ///< share of 8 x 6 cells of the image with a corner
  double slant_deg = 0;     ///< angle of the board to the image plane, 90 % quantile
  double bend_m = 0;        ///< largest distance of its corners from a plane; 0 if taken as flat
  std::vector<std::string> warnings;
};

/// Least squares over at most 60 different views (`choose_views`), then without those that fit far
/// worse than the others. Successive views share their errors (blur, rolling shutter, the same part
/// of the lens), so the standard deviations of the least squares are too small; leaving out blocks
/// of time shows how far the result depends on them. If every view shows all corners, a board that
/// is not flat shows in the residuals, and its shape is estimated: a bend of half a percent of its
/// width changes a focal length by percents.
///
/// Coefficients that the views do not determine are fixed at 0, with a warning: those within three
/// standard deviations of 0, if these are above 10 or shift the image corner by a quarter of its
/// distance from the center. A focal length or principal point that is not determined (5 % of the
/// focal length) is a failure.
CameraCalibration calibrate_camera(const BoardSearch& search,
                                   const Board& board,
                                   const CalibrationOptions& options = {});

}  // namespace gpo
