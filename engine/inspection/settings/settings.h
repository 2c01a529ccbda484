// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/tracking.h"
#include "engine/initialize.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace gpo {

/// All inputs of a result other than the recording. Immutable in use. Each field has a row in
/// `settings_table`.
struct Settings {
  int start = 0;                           ///< reference frame, counts in the recording
  int frames = 30;                         ///< length of the window
  Tracking tracking = Tracking::anchored;  ///< by the built-in front end
  std::vector<std::int64_t> exclude = {};  ///< ids of excluded tracks, ascending
  InitializeOptions options = {};          ///< how the window's tracks are initialized

  bool operator==(const Settings&) const = default;
};

/// Named sets of settings: the defaults, which are the most accurate; and those of the paper:
/// corners tracked from frame to frame, inliers by frame, an uncalibrated gyroscope, `gpo` by Ceres
/// starting without translation.
enum class Preset { best, paper };

template <>
struct ChoiceKeys<Preset> {
  static constexpr const char* name = "preset";
  static constexpr std::array keys{"best", "paper"};
};

/// Returns the settings with a preset applied. It does not change window, seed, excluded tracks,
/// leading plane and threshold.
Settings with_preset(Settings settings, Preset preset);

/// Returns the preset that the settings match; nullopt if they are modified.
std::optional<Preset> preset_of(const Settings& settings);

}  // namespace gpo
