// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/inspector.h"

#include "engine/base/error.h"
#include "engine/inspection/stages.h"
#include "engine/inspection/window/window_rotations.h"

#include <utility>

#include <fmt/format.h>

namespace gpo {
namespace {

void check_window(const Recording& recording, const Settings& settings) {
  const int count = recording.frame_count();
  if (settings.frames < 2) {
    throw SettingError("frames", fmt::format("{}, expected at least 2", settings.frames));
  }
  if (settings.start < 0 || settings.start >= count) {
    throw SettingError("start",
                       fmt::format("frame {} is not in the recording, which has frames 0 to {}",
                                   settings.start,
                                   count - 1));
  }
  if (settings.start + settings.frames > count) {
    throw SettingError(
        "frames",
        fmt::format("{} frames from frame {} on do not fit, the recording has {} frames",
                    settings.frames,
                    settings.start,
                    count));
  }
}

void without_plane(Evaluation& evaluation) {
  evaluation.pne_deg.reset();
  evaluation.pne_aligned_deg.reset();
  evaluation.pde_m.reset();
  evaluation.pne_bound_deg.reset();
}

/// Gravity and meters beside the truth's.
void compare(const InertialAlignment& inertial, const WindowTruth& truth, Evaluation& evaluation) {
  if (!inertial.ok) return;
  if (inertial.scale_known && evaluation.scale)
    evaluation.scale_error_percent = 100 * (inertial.scale / *evaluation.scale - 1);
  if (!truth.upright || !truth.cameras.front()) return;
  const Eigen::Vector3d down = -truth.cameras.front()->R_wc.row(2).transpose();
  evaluation.gravity_error_deg = angle_deg(inertial.gravity_m_s2, down);
}

}  // namespace

Inspector::Inspector(std::shared_ptr<const Recording> recording)
    : stages_(std::make_unique<Stages>()) {
  stages_->recording = std::move(recording);
}

Inspector::~Inspector() = default;

std::shared_ptr<const Inspection> Inspector::inspect(const Settings& settings,
                                                     const std::stop_token& stop,
                                                     const Progress& progress) {
  Stages& stages = *stages_;
  check_window(*stages.recording, settings);
  settings.options.method.row();  // throws before any work is done
  Inspection inspection;
  inspection.recording = stages.recording;
  inspection.settings = settings;
  rotation_source_used(*stages.recording, settings.options.rotations);  // so does this
  const bool prepared = stages.update_tracks(settings, stop, progress) &&
                        stages.update_truth(settings, stop, progress) &&
                        stages.update_window(settings, stop);
  if (!prepared) return nullptr;
  if (progress) progress("initializing", 0, 0);
  stages.initialize(settings, stop, progress, inspection);
  if (stop.stop_requested()) return nullptr;
  if (inspection.initialization->ok) {
    // The truth is of one plane, which is taken to be the one with most tracks.
    const bool leads_truth = settings.options.plane == 1;
    if (inspection.truth) {
      inspection.evaluation = evaluate(
          *inspection.initialization, *inspection.window, *inspection.truth, settings.options.seed);
      if (!leads_truth) without_plane(*inspection.evaluation);
      if (inspection.inertial)
        compare(*inspection.inertial, *inspection.truth, *inspection.evaluation);
    }
    const auto place = [&](const Plane& plane, const Pose& reference) {
      return place_cube(
          plane, reference, *inspection.recording, *inspection.window, stages.board_corners.value);
    };
    inspection.cube = place(inspection.initialization->plane, Pose{});
    const WindowTruth* truth = inspection.truth.get();
    if (leads_truth && truth != nullptr && truth->plane && truth->cameras.front())
      inspection.true_cube = place(*truth->plane, *truth->cameras.front());
  }
  return std::make_shared<const Inspection>(std::move(inspection));
}

}  // namespace gpo
