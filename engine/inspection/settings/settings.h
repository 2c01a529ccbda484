// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking/tracking.h"
#include "engine/initialize.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace gpo {

/// Everything that a result depends on beside the recording. Immutable in use. One more field is
/// one more row in `settings_table`.
struct Settings {
  int start = 0;                           ///< reference frame, counts in the recording
  int frames = 30;                         ///< length of the window
  Tracking tracking = Tracking::anchored;  ///< of the built-in front end
  /// Ids of tracks that are left out as if they had never been seen, ascending.
  std::vector<std::int64_t> exclude = {};
  InitializeOptions options = {};  ///< how the window's tracks are initialized

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

}  // namespace gpo
