// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/recording/recording.h"

#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The board in one image.
struct CalibrationView {
  int frame = 0;
  std::vector<Eigen::Vector2d> corners;  ///< [raw px], as `find_board` returns them
  double edge_px = 0;                    ///< width of the edges between squares, at least 1
  /// Velocities of the corners [raw px/s], by the images before and after; empty if unknown.
  std::vector<Eigen::Vector2d> velocities_px_s = {};
};

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
  /// One per view, for each seen corner a column: its place, and its distance from the projection
  /// [px].
  std::vector<Eigen::Matrix4Xd> residuals_px;
  std::vector<double> slant_deg;  ///< one per view
  double bend_m = 0;              ///< largest distance of a bent board's corners from a plane
};

/// True if the views determine how a board bends: all corners in all views, no equidistant lens.
bool bend_is_observable(const std::vector<CalibrationView>& views, Distortion distortion);

/// Minimizes the reprojection errors of the corners in all views, from several focal lengths if no
/// solution is known and the lens is equidistant; nullopt if no result is plausible.
std::optional<LensFit> fit_lens(const std::vector<CalibrationView>& views,
                                const Board& board,
                                const LensStart& start);

}  // namespace gpo
