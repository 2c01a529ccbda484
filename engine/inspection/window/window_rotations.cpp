// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/window/window_rotations.h"

#include "engine/base/error.h"
#include "engine/frontend/gyro_calibration.h"
#include "engine/frontend/homography_rotations.h"
#include "engine/frontend/pair_rotations.h"
#include "engine/initializers/common/window_checks.h"

#include <fmt/format.h>

namespace gpo {
namespace {

std::vector<Eigen::Matrix3d> true_rotations(const WindowTruth* truth, int start) {
  std::vector<Eigen::Matrix3d> R_wc;
  for (std::size_t i = 0; truth != nullptr && i < truth->cameras.size(); ++i) {
    const auto& reference = truth->cameras.front();
    if (!reference || !truth->cameras[i]) {
      throw SettingError("rotations",
                         fmt::format("truth: frame {} has no ground truth ({})",
                                     start + static_cast<int>(reference ? i : 0),
                                     truth->source));
    }
    R_wc.push_back(reference->R_wc.transpose() * truth->cameras[i]->R_wc);
  }
  if (R_wc.empty()) throw SettingError("rotations", "truth: the window has no ground truth");
  return R_wc;
}

Rotations rotations_from(const Recording& recording,
                         const Window& window,
                         const WindowTruth* truth,
                         RotationSource source,
                         const RansacOptions& ransac,
                         const std::stop_token& stop) {
  const auto& gyroscope = recording.gyroscope;
  if (source == RotationSource::gyro) {
    return sensitive_gyro_rotations(*gyroscope, window.timestamps_ns);
  }
  if (source == RotationSource::truth) return {true_rotations(truth, window.start), ""};
  if (auto reason = reason_not_to_try(window)) return {{}, *reason};
  if (source == RotationSource::averaging) return averaged_rotations(window, stop);
  if (source == RotationSource::gyro_calibrated)
    return calibrated_gyro_rotations(*gyroscope, window, stop);
  const auto solver =
      source == RotationSource::direct ? RelativeSolver::eigensolver : RelativeSolver::five_point;
  return pair_rotations(window, {solver, ransac.threshold_px, ransac.seed}, stop);
}

}  // namespace

std::string why_no_rotations(const Recording& recording, RotationSource source) {
  if (needs_gyroscope(source) && !recording.gyroscope) return recording.name + " has no gyroscope";
  const bool truth = recording.truth || (recording.board && recording.pictures);
  if (source == RotationSource::truth && !truth)
    return recording.name + " has no ground truth, and no pictures of a board to compute it from";
  return "";
}

RotationSource rotation_source_used(const Recording& recording, RotationSource asked) {
  if (asked == RotationSource::automatic || asked == RotationSource::raw) {
    const bool raw = asked == RotationSource::raw;
    if (!recording.gyroscope) return raw ? RotationSource::averaging : RotationSource::five_point;
    return raw ? RotationSource::gyro : RotationSource::gyro_calibrated;
  }
  if (const std::string why_not = why_no_rotations(recording, asked); !why_not.empty())
    throw SettingError("rotations", fmt::format("{}: {}", to_string(asked), why_not));
  return asked;
}

std::string automatic_rotations(const Recording& recording) {
  return recording.gyroscope ? to_string(RotationSource::gyro_calibrated)
                             : fmt::format("{} or {}",
                                           to_string(RotationSource::five_point),
                                           to_string(RotationSource::averaging));
}

ChosenRotations window_rotations(const Recording& recording,
                                 const Window& window,
                                 const WindowTruth* truth,
                                 RotationSource asked,
                                 const RansacOptions& ransac,
                                 const std::stop_token& stop) {
  const auto from = [&](RotationSource source) {
    return rotations_from(recording, window, truth, source, ransac, stop);
  };
  const RotationSource first = rotation_source_used(recording, asked);
  ChosenRotations chosen{first, from(first)};
  chosen.note = chosen.rotations.note;
  const bool settled = !chosen.rotations.R_wc.empty() || chosen.rotations.stopped;
  if (asked != RotationSource::automatic || settled) return chosen;
  chosen.note = chosen.rotations.reason;
  chosen.source = recording.gyroscope ? RotationSource::gyro : RotationSource::averaging;
  chosen.rotations = from(chosen.source);
  if (!chosen.rotations.note.empty()) chosen.note += "; " + chosen.rotations.note;
  return chosen;
}

}  // namespace gpo
