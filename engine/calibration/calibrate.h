// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/calibration_views.h"
#include "engine/calibration/camera_parameters.h"
#include "engine/geometry/camera.h"

#include <string>
#include <vector>

namespace gpo {

struct CalibrationOptions {
  Distortion distortion = Distortion::radial_tangential;  ///< or equidistant
  int coefficients = 4;  ///< of radial_tangential: 4 (k1 k2 p1 p2), 5 or 8; equidistant has 4
  int most_views = 60;   ///< that are used of those found
};

/// A camera from its own views of a board, or the reason why there is none.
struct CameraCalibration {
  bool ok = false;
  std::string reason;  ///< why not
  Camera camera;
  /// Standard deviations of fx, fy, cx, cy [px] and the coefficients [-]: by a jackknife over ten
  /// blocks of time, or the least squares' own where they are larger; 0 of what is left at 0.
  std::vector<double> sigmas;
  double rms_px = 0;        ///< distance of the corners from where the model puts them [raw px]
  int examined = 0;         ///< pictures
  int found = 0;            ///< of them with the board
  std::vector<int> frames;  ///< used
  double coverage = 0;      ///< of the picture, in cells of 8 x 6, where corners were
  double slant_deg = 0;     ///< of the board to the picture's plane: nine tenths are below
  double bend_m = 0;        ///< its corners' largest distance off a plane; 0: taken as flat
  std::vector<std::string> warnings;
};

/// Least squares over views that differ (`choose_views`), again without those that fit far worse
/// than the others. Views that follow one another share their errors (blur, rolling shutter, the
/// same part of the lens), so the least squares' own standard deviations are too small; leaving out
/// blocks of time shows how far the result depends on them. Where every view shows all corners, a
/// board that is not flat is told by its fit, and taken as it is: half a percent of its width moves
/// a focal length by percents. Of a board of another size they know nothing.
///
/// A coefficient that the views do not determine is left at 0, with a warning that names it: one
/// that is within three standard deviations of 0, where these are above 10 or each would shift the
/// corner of the picture by a quarter of its distance from the middle. A focal length or principal
/// point that is not determined (5 % of the focal length) is a failure.
CameraCalibration calibrate_camera(const BoardSearch& search,
                                   const Board& board,
                                   const CalibrationOptions& options = {});

}  // namespace gpo
