// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/inertial/inertial_alignment.h"
#include "engine/inspection/cube.h"
#include "engine/inspection/motion.h"
#include "engine/inspection/settings/settings.h"
#include "engine/methods/common/initialization.h"
#include "engine/recording/recording.h"
#include "engine/window/tracks.h"
#include "engine/window/window.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Milliseconds a stage took when it was computed.
struct Timing {
  double track = 0, ransac = 0, rotations = 0, initialize = 0, optimize = 0, total = 0;
};

/// One finished inspection: the chain of results for one recording and settings. Immutable; shared
/// with the views by shared_ptr<const>.
struct Inspection {
  std::shared_ptr<const Recording> recording;
  Settings settings;
  RotationSource rotations_used = RotationSource::gyro;  ///< never automatic
  std::string rotations_note;  ///< why not what `automatic` tries first, or what told them
  std::optional<Eigen::Vector3d> gyroscope_bias_rad_s;  ///< what was taken off its rates
  std::shared_ptr<const Tracks> tracks;
  std::shared_ptr<const Window> window;
  std::shared_ptr<const WindowTruth> truth;  ///< null where none is known
  std::shared_ptr<const Initialization> initialization;
  /// Gravity and meters, of an initialization that is ok; nothing where they are not asked for, or
  /// the recording has no accelerometer.
  std::optional<InertialAlignment> inertial;
  /// Frame of the window up to which it takes to know the scale; nothing where it is not known.
  std::optional<int> metric_scale_from;
  /// Verdicts of the windows of 2, 3, ... frames from the same start, as the window grows.
  std::vector<Verdict> growth;
  std::vector<FrameMotion> motion;       ///< one a frame of the window; empty without rotations
  std::optional<Evaluation> evaluation;  ///< of an initialization that is ok, where truth is known
  std::optional<CubeAnchor> cube;  ///< on the estimated plane, of an initialization that is ok
  std::optional<CubeAnchor>
      true_cube;  ///< the same place on the true plane, in the truth's world;
                  ///< its side is that of `cube` times true_cube.unit / cube.unit
  Timing timing;
};

/// What its inliers are a share of and how they were told, for people: "tracks, consistent".
std::string inliers_note(const Inspection& inspection);

}  // namespace gpo
