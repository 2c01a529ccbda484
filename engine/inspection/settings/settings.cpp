// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings/settings.h"

#include "engine/initialize/steps.h"

#include <utility>

namespace gpo {
namespace {

Settings paper() {
  Settings settings;
  settings.method = "gpo";
  settings.rotations = RotationSource::raw;
  settings.tracking = Tracking::frame_to_frame;
  settings.inliers = Inliers::per_frame;
  settings.initializer = {.solver = Solver::ceres,
                          .loss = Loss::squared,
                          .shutter = Shutter::global,
                          .planes = Planes::one};
  return settings;
}

}  // namespace

Settings with_preset(Settings settings, Preset preset) {
  Settings chosen = preset == Preset::best ? Settings{} : paper();
  chosen.start = settings.start;
  chosen.frames = settings.frames;
  chosen.ransac_threshold_px = settings.ransac_threshold_px;
  chosen.plane = settings.plane;
  chosen.seed = settings.seed;
  chosen.exclude = std::move(settings.exclude);
  return chosen;
}

std::optional<Preset> preset_of(const Settings& settings) {
  for (const Preset preset : {Preset::best, Preset::paper})
    if (settings == with_preset(settings, preset)) return preset;
  return std::nullopt;
}

InitializeOptions options_of(const Settings& settings) {
  return {.method = settings.method,
          .rotations = settings.rotations,
          .ransac = settings.ransac,
          .ransac_threshold_px = settings.ransac_threshold_px,
          .inliers = settings.inliers,
          .plane = settings.plane,
          .seed = settings.seed,
          .gravity = settings.gravity,
          .initializer = settings.initializer};
}

bool uses_ransac(const Settings& settings) { return uses_ransac(options_of(settings)); }

Inliers inliers_used(const Settings& settings) { return inliers_used(options_of(settings)); }

Gravity gravity_used(const Settings& settings) { return gravity_used(options_of(settings)); }

}  // namespace gpo
