// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/rotations.h"
#include "engine/inspection/inspection.h"
#include "engine/inspection/window/cached.h"
#include "engine/inspection/window/progress.h"
#include "engine/inspection/window/window_rotations.h"
#include "engine/inspection/window/window_tracks.h"

#include <array>
#include <memory>
#include <tuple>
#include <vector>

#include <Eigen/Core>

namespace gpo {

using Span = std::tuple<int, int>;  // start, frames

/// What an inspector keeps between two inspections, and how it is brought up to date; each `update`
/// is false where it was stopped. The key of a stage is the settings that act until then
/// (`acting_until`), so that a setting's row decides which stages it makes anew.
struct Stages {
  std::shared_ptr<const Recording> recording;
  std::array<Cached<Span, Tracked>, 2> longest_tracks;  // of the windows from one start, by tracking
  Cached<Span, std::shared_ptr<const WindowTruth>> longest_truth;
  Cached<Settings, std::shared_ptr<const Tracks>> tracks;
  Cached<Span, std::shared_ptr<const WindowTruth>> truth;
  Cached<int, std::vector<Eigen::Vector2d>> board_corners;  // in the reference picture
  Cached<Settings, std::shared_ptr<const Window>> outliers;
  Cached<Settings, ChosenRotations> rotations;
  Cached<Settings, std::vector<Verdict>> growth;

  bool update_tracks(const Settings& settings,
                     const std::stop_token& stop,
                     const Progress& progress);
  bool update_truth(const Settings& settings,
                    const std::stop_token& stop,
                    const Progress& progress);
  bool update_window(const Settings& settings, const std::stop_token& stop);
  /// The method's result on what the other stages made, with its growth; into `inspection`.
  void initialize(const Settings& settings,
                  const std::stop_token& stop,
                  const Progress& progress,
                  Inspection& inspection);
};

}  // namespace gpo
