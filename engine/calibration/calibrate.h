// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <set>
#include <span>
#include <string>

#include <opencv2/core.hpp>

namespace gpo {

/// The board in one image.
struct CalibrationView {
  int frame = 0;
  std::vector<Eigen::Vector2d> corners;  ///< [raw px], as `find_board` returns them
  double edge_px = 0;                    ///< width of the edges between squares, at least 1
  /// Of the corners [raw px/s], by the images before and after; empty if unknown.
  std::vector<Eigen::Vector2d> velocities_px_s = {};
};

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

/// Names and values of the calibrated parameters: fx, fy, cx, cy, then the coefficients.
std::vector<std::string> parameter_names(const Camera& camera);
std::vector<double> parameters(const Camera& camera);

/// Indices in `Camera::coefficients` of coefficients that are fixed at 0.
using HeldCoefficients = std::set<std::size_t>;

struct LensCoefficient {
  int power;  ///< exponent of the distance from the image center in the relative shift of a point
  int hold;   ///< OpenCV's flag that fixes it at 0
};

/// One per index in `Camera::coefficients`, for the longest model.
std::span<const LensCoefficient> coefficients_of(Distortion distortion);

struct LensStart {
  Camera camera;
  bool known = false;       ///< whether `camera` has a solution to start from
  bool with_sigmas = true;  ///< compute standard deviations, which takes longer than all the rest
  HeldCoefficients held{};
  double readout_s = 0;  ///< by which corners are read later; see `Readout`
  /// Estimate the corners' places, too: paper bends, printers stretch. See `bend_is_observable`.
  bool bent = false;
};

struct LensFit {
  Camera camera;
  double rms_px = 0;
  std::vector<double> sigmas;       ///< empty if not computed
  std::vector<double> view_rms_px;  ///< one per view
  std::vector<double> slant_deg;    ///< one per view
  double bend_m = 0;                ///< largest distance of a bent board's corners from a plane
};

/// True if the views determine how a board bends: all corners in all views, no equidistant lens.
bool bend_is_observable(const std::vector<CalibrationView>& views, Distortion distortion);

/// Minimizes the reprojection errors of the corners in all views; nullopt if the result is not
/// plausible.
std::optional<LensFit> fit_lens(const std::vector<CalibrationView>& views,
                                const Board& board,
                                const LensStart& start);

}  // namespace gpo
