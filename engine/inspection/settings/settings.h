// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/frontend/tracking/tracking.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/initialize.h"
#include "engine/initializers/common/initializer_options.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Everything that a result depends on beside the recording. Immutable in use. A field more is a
/// row more in `settings_table`.
struct Settings {
  int start = 0;                     ///< reference frame, counts in the recording
  int frames = 30;                   ///< length of the window
  std::string method = "gpo_joint";  ///< key in `methods()`
  RotationSource rotations = RotationSource::automatic;  ///< gyroscope, five-point, averaging
  Tracking tracking = Tracking::anchored;                ///< of the built-in front end
  /// Whether tracks off the plane are rejected by homography RANSAC; nothing: as the method's
  /// authors do (`uses_ransac`).
  std::optional<bool> ransac = std::nullopt;
  double ransac_threshold_px = 2.0;  ///< transfer error of an inlier, one-sided
  /// Which tracks count as inliers; nothing: as the method does (`inliers_used`).
  std::optional<Inliers> inliers = std::nullopt;
  int plane = 1;           ///< of the window's planes that which leads, by their support
  std::uint64_t seed = 1;  ///< of every random choice
  /// Ids of tracks that are left out as if they had never been seen, ascending.
  std::vector<std::int64_t> exclude = {};
  InitializerOptions initializer = {};
  Gravity gravity = Gravity::after;  ///< gravity and meters, where there is an accelerometer

  bool operator==(const Settings&) const = default;
};

/// Whole sets of settings by one word: the best that we have, which are the defaults; and what the
/// paper does: corners followed from frame to frame, inliers told frame by frame, the gyroscope as
/// it is, `gpo` from rest by Ceres.
enum class Preset { best, paper };

template <>
struct ChoiceKeys<Preset> {
  static constexpr const char* name = "preset";
  static constexpr std::array keys{"best", "paper"};
};

/// The settings with all that a preset decides as it has it; what it does not, as it was: the
/// window, the seed, tracks left out, thresholds.
Settings with_preset(Settings settings, Preset preset);

/// The preset that the settings are an instance of; nothing: modified.
std::optional<Preset> preset_of(const Settings& settings);

/// Those of them that initialize a window of tracks.
InitializeOptions options_of(const Settings& settings);

/// What `ransac` comes to. Chosen, or by default on for the methods that need a plane and off for
/// those that use all tracks (ba, pnp_ba). Throws InputError for an unknown method.
bool uses_ransac(const Settings& settings);

/// What `inliers` comes to. Throws InputError for an unknown method.
Inliers inliers_used(const Settings& settings);

/// What `gravity` comes to. Throws InputError for an unknown method.
Gravity gravity_used(const Settings& settings);

}  // namespace gpo
