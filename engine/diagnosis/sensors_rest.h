// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/methods/common/initialization.h"
#include "engine/window/gyroscope.h"
#include "engine/window/window.h"

#include <limits>
#include <optional>
#include <vector>

namespace gpo {

/// A window in which the sensors are at rest while the tracks of the plane move.
struct SensorsRest {
  bool accelerometer = false;  ///< there is one, and it is at rest, too
  double moved_px = 0;         ///< median over the plane's tracks of their largest distance
  /// Rotation of the result that the gyroscope does not measure; 0 if its bias is unknown [deg].
  double turned_deg = 0;
  double tilted_deg = 0;     ///< change of the direction of gravity by the result [deg]
  double uncertain_deg = 0;  ///< three standard deviations of the result's rotations [deg]
  /// Largest distance of the plane that the accelerometer allows for the result's path.
  double most_m = std::numeric_limits<double>::infinity();
  std::vector<int> still_tracks{};  ///< columns of tracks that do not move

  bool is_tilted() const;
  bool is_too_close() const;
  /// Returns whether the result turns, whatever moves.
  bool is_turned() const;
  /// Returns whether the camera rests, so that the plane moves.
  bool camera_rests() const;
};

/// Returns the evidence of a window; nullopt if a sensor is not at rest or the plane's tracks do
/// not move. A rejected solution counts as well.
std::optional<SensorsRest> sensors_rest(const Window& window,
                                        const Gyroscope& gyroscope,
                                        const Initialization& result);

}  // namespace gpo
