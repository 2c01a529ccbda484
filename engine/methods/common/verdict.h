// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// Whether a window is fit to initialize from.
enum class Readiness { ready, weak, degenerate, no_plane };

template <>
struct ChoiceKeys<Readiness> {
  static constexpr const char* name = "readiness";
  static constexpr std::array keys{"ready", "weak", "degenerate", "no plane"};
};

/// What the tracks of a window lie on.
enum class SceneKind { not_told, one_plane, several_planes, no_plane };

template <>
struct ChoiceKeys<SceneKind> {
  static constexpr const char* name = "scene";
  static constexpr std::array keys{"not told", "one plane", "several planes", "no plane"};
};

/// What speaks for a plane of the window.
struct PlaneEvidence {
  double track_share = 0;    ///< of the window's tracks [-]
  double image_share = 0;  ///< of the reference picture, inside its tracks' hull [-]
  double stability = 0;      ///< share of its tracks that stay where the gate is halved [-]
};

/// Torr's criterion (GRIC, 1998) of two descriptions of all tracks, between the reference frame and
/// the one whose camera is farthest from it; the lower one is better.
struct SceneCriterion {
  double planes = 0;       ///< each track on one of the window's planes
  double free_points = 0;  ///< each track a point of its own, by the cameras' epipolar geometry
};

/// With the numbers that it rests on; what could not be computed is empty.
struct Verdict {
  Readiness readiness = Readiness::degenerate;
  std::string reason;                         ///< one sentence, for people; with numbers
  std::optional<double> normal_sigma_deg;     ///< of the normal, uncertain rotations marginalized
  std::optional<double> rotation_rms_px;      ///< of the best rotations alone, frame by frame
  std::optional<double> noise_px;             ///< of one coordinate, what the homographies leave
  std::optional<double> largest_translation;  ///< largest |tau| [plane distance]
  SceneKind scene = SceneKind::not_told;      ///< of inliers that are told by planes
  std::vector<PlaneEvidence> planes = {};     ///< the largest one first
  std::optional<SceneCriterion> criterion = std::nullopt;
};

}  // namespace gpo
