// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/settings/settings.h"

#include <utility>

namespace gpo {
namespace {

Settings paper() {
  Settings settings;
  settings.options.method = "gpo";
  settings.options.rotations = RotationSource::raw;
  settings.tracking = Tracking::frame_to_frame;
  settings.options.inliers = Inliers::per_frame;
  settings.options.method_options = {.solver = Solver::ceres,
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
  chosen.options.ransac_threshold_px = settings.options.ransac_threshold_px;
  chosen.options.plane = settings.options.plane;
  chosen.options.seed = settings.options.seed;
  chosen.exclude = std::move(settings.exclude);
  return chosen;
}

std::optional<Preset> preset_of(const Settings& settings) {
  for (const Preset preset : {Preset::best, Preset::paper})
    if (settings == with_preset(settings, preset)) return preset;
  return std::nullopt;
}

}  // namespace gpo
