// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/frontend/tracking.h"
#include "engine/initializers/common/initializer_options.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Everything that a result depends on beside the recording. Immutable in use.
struct Settings {
  int start = 0;               ///< reference frame, counts in the recording
  int frames = 30;             ///< length of the window
  std::string method = "gpo";  ///< key in `methods()`
  RotationSource rotations = RotationSource::automatic;  ///< gyroscope, else averaging
  Tracking tracking = Tracking::frame_to_frame;          ///< of the built-in front end
  /// Whether tracks off the plane are rejected by homography RANSAC; nothing: as the method's
  /// authors do (`uses_ransac`).
  std::optional<bool> ransac = std::nullopt;
  double ransac_threshold_px = 2.0;  ///< transfer error of an inlier, one-sided
  /// Which tracks count as inliers; nothing: as the method does (`inliers_used`).
  std::optional<Inliers> inliers = std::nullopt;
  std::uint64_t seed = 1;  ///< of every random choice
  /// Ids of tracks that are left out as if they had never been seen, ascending.
  std::vector<std::int64_t> exclude = {};
  InitializerOptions initializer = {};

  bool operator==(const Settings&) const = default;
};

/// What `ransac` comes to. Chosen, or by default on for the methods that need a plane and off for
/// those that use all tracks (ba, pnp_ba). Throws InputError for an unknown method.
bool uses_ransac(const Settings& settings);

/// What `inliers` comes to. Throws InputError for an unknown method.
Inliers inliers_used(const Settings& settings);

/// How a setting is called and explained, wherever it is shown.
struct SettingInfo {
  const char* key;    ///< in JSON, and with dashes on the command line
  const char* title;  ///< in the window
  const char* unit;   ///< empty: none
  const char* help;   ///< one sentence
  double least = 0;   ///< range of a number
  double most = 0;
};

/// The one declaration of the settings: the command line, the JSON result and the panel each visit
/// it with `visit(SettingInfo, value&)`.
template <class S, class Visitor>
void visit_settings(S& settings, Visitor&& visit) {
  visit(
      SettingInfo{
          "start", "Start", "frame", "First frame of the window, its reference frame", 0, 1e9},
      settings.start);
  visit(SettingInfo{"frames", "Frames", "", "Length of the window", 2, 1000}, settings.frames);
  visit(SettingInfo{"method", "Method", "", "Initializer"}, settings.method);
  visit(SettingInfo{"rotations", "Rotations", "", "Where the camera rotations come from"},
        settings.rotations);
  visit(SettingInfo{"tracking", "Tracking", "", "How the built-in front end follows corners"},
        settings.tracking);
  visit(
      SettingInfo{
          "ransac",
          "RANSAC",
          "",
          "Reject tracks off the plane by a homography from the reference frame; default: as the "
          "method does"},
      settings.ransac);
  visit(
      SettingInfo{
          "ransac_threshold_px", "Threshold", "px", "Largest transfer error of an inlier", 0.1, 50},
      settings.ransac_threshold_px);
  visit(SettingInfo{"inliers",
                    "Inliers",
                    "",
                    "Tracks on the plane: told frame by frame, or consistent over the window; "
                    "default: as the method does"},
        settings.inliers);
  visit(SettingInfo{"seed", "Seed", "", "Seed of every random choice", 0, 1e9}, settings.seed);
  visit(SettingInfo{"exclude", "Excluded", "", "Tracks left out by hand, by their ids"},
        settings.exclude);
  visit(SettingInfo{"solver", "Solver", "", "Who minimizes: our own Schur solver, or Ceres"},
        settings.initializer.solver);
  visit(SettingInfo{"error", "Error", "", "Of gpo_joint: one-sided transfer error, or Sampson's"},
        settings.initializer.error);
  visit(SettingInfo{"loss", "Loss", "", "Of gpo_joint: squared, or Huber's, linear for outliers"},
        settings.initializer.loss);
  visit(
      SettingInfo{"shutter",
                  "Shutter",
                  "",
                  "Of gpo_joint: rows read one after another at an estimated pace, or all at once"},
      settings.initializer.shutter);
  visit(SettingInfo{"time_offset",
                    "Time offset",
                    "",
                    "Of gpo_joint: estimate the offset between the clocks of camera and gyroscope"},
        settings.initializer.time_offset);
}

}  // namespace gpo
