// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/lens_fit.h"

#include <span>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// All views that a search found, in the order of time.
struct BoardSearch {
  cv::Size size;     ///< image size [px]
  int examined = 0;  ///< images
  std::vector<CalibrationView> views;
  /// Inner corners of the chessboard that the images show instead, if the board is in none.
  std::optional<cv::Size> other_counts = std::nullopt;
};

/// Searches at most `most_frames` images, evenly spread, on all processors. Leaves out views with
/// fewer than 8 corners, or less than a whole tag if the board has only one. With the frames' times
/// images are searched five in a row, and views get velocities. Throws InputError if an image
/// cannot be decoded or differs in size, and Stopped.
BoardSearch find_calibration_views(const FrameCache& images,
                                   const Board& board,
                                   int most_frames,
                                   const std::function<void(int done, int of)>& progress = {},
                                   std::span<const std::int64_t> frame_times_ns = {});

/// Chooses at most `count` views that differ most in place, size and slant, the sharper ones of
/// similar views, in the order of time. Leaves out views with edges of twice the median width, and
/// views without velocities if most have them.
std::vector<CalibrationView> choose_views(const BoardSearch& search, const Board& board, int count);

struct CalibrationOptions {
  Distortion distortion = Distortion::radial_tangential;  ///< or equidistant
  int coefficients = 4;  ///< radial_tangential: 4 (k1 k2 p1 p2), 5 or 8; equidistant: 4
  std::optional<Readout> readout = std::nullopt;                     ///< nullopt: estimate it
  std::optional<ReadoutDirection> readout_direction = std::nullopt;  ///< nullopt: down
};

/// Result of a calibration with a board.
struct CameraCalibration {
  bool ok = false;
  std::string reason;  ///< why there is no camera
  /// Its standard deviations are the larger ones of a jackknife over ten blocks of time and of the
  /// least squares, which are multiplied if halves of these blocks disagree by more; 0 of
  /// coefficients fixed at 0. Its readout is the given one, else the estimate if that is
  /// significant.
  Camera camera;
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
/// of the lens), so leaving out blocks of time gives larger, realistic standard deviations. If
/// every view shows all corners, the board's shape is estimated, too: a bend of half a percent of
/// its width changes a focal length by percents. If the views have velocities, so is the readout
/// time, which otherwise shifts the principal point. Coefficients that the views do not determine
/// are fixed at 0, with a warning; a focal length or principal point that they do not determine is
/// a failure.
CameraCalibration calibrate_camera(const BoardSearch& search,
                                   const Board& board,
                                   const CalibrationOptions& options = {});

}  // namespace gpo
