// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/tracking.h"
#include "engine/inspection/settings.h"
#include "engine/window/window.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace gpo {

/// A method, and the settings in which it differs from its own defaults: what an experiment
/// compares. Written `METHOD[+ransac|+no-ransac][+ROTATIONS][+anchored][+consistent|+per-frame]`,
/// e.g. `gpo`, `gpo+no-ransac`, `gpo+averaging`.
struct Configuration {
  std::string method;                         ///< key in `methods()`
  std::optional<bool> ransac = std::nullopt;  ///< nothing: as the method does by default
  RotationSource rotations = RotationSource::automatic;
  Tracking tracking = Tracking::frame_to_frame;
  std::optional<Inliers> inliers = std::nullopt;  ///< nothing: as the method does by default

  bool operator==(const Configuration&) const = default;
};

/// Reads one; what only repeats a default is dropped, so that equal configurations have equal keys.
/// Throws InputError that names `--methods`, what was found and what is known.
Configuration parse_configuration(const std::string& text);

/// Reads a list with commas, each configuration once. `all` stands for every method and the paper's
/// ablations. Throws InputError.
std::vector<Configuration> parse_configurations(const std::string& text);

/// As it is written on the command line and in files.
std::string key_of(const Configuration& configuration);
/// For people: "GPO without RANSAC".
std::string title_of(const Configuration& configuration);
/// The method's color, or for an ablation one of its own; 0xRRGGBB.
std::uint32_t color_of(const Configuration& configuration);

/// What of the settings a configuration says; as `parse_configuration` reads it back.
Configuration configuration_of(const Settings& settings);

/// The settings with method, RANSAC, rotations, tracking and inliers as configured.
Settings apply(const Configuration& configuration, Settings settings);

}  // namespace gpo
