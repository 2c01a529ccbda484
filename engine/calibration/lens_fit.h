// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/calibration_views.h"
#include "engine/geometry/camera.h"

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace gpo {

/// Coefficients of the lens that are held at 0, by their places in `Camera::coefficients`.
using HeldCoefficients = std::set<std::size_t>;

/// What is known of a coefficient before it is estimated.
struct LensCoefficient {
  int power;  ///< of a point's distance from the middle in the point's relative shift
  int hold;   ///< OpenCV's flag that leaves it at 0
};

/// One for each place in `Camera::coefficients`, of the longest model.
std::span<const LensCoefficient> coefficients_of(Distortion distortion);

/// From which camera, whether it is one already, and whether the least squares' own standard
/// deviations are wanted, which takes longer than all the rest.
struct LensStart {
  Camera camera;
  bool known = false;
  bool with_sigmas = true;
  HeldCoefficients held{};
  /// The board's corners may be off their plane, and off their grid: paper bends, printers stretch.
  /// Only where every view shows all of them, and not with an equidistant lens.
  bool bent = false;
};

/// One least squares.
struct LensFit {
  Camera camera;
  double rms_px = 0;
  std::vector<double> sigmas;       ///< the least squares' own; empty where it tells none
  std::vector<double> view_rms_px;  ///< one a view
  std::vector<double> slant_deg;    ///< one a view
  double bend_m = 0;                ///< of a bent board: its corners' largest distance off a plane
};

/// Whether the views tell how a board bends.
bool can_tell_bend(const std::vector<CalibrationView>& views, Distortion distortion);

/// The camera that brings the corners of all views nearest to where they were seen. Nothing where
/// the least squares come to nothing sensible.
std::optional<LensFit> fit_lens(const std::vector<CalibrationView>& views,
                                const Board& board,
                                const LensStart& start);

}  // namespace gpo
