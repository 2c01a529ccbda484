// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/pipeline/chosen_rotations.h"

#include "engine/frontend/rotations.h"
#include "engine/methods/common/window_checks.h"

namespace gpo {
namespace {

Rotations rotations_from(const Window& window,
                         const Gyroscope* gyroscope,
                         std::span<const Eigen::Matrix3d> R_wc_true,
                         RotationSource source,
                         const RansacOptions& ransac,
                         const std::stop_token& stop) {
  if (source == RotationSource::gyro)
    return sensitive_gyro_rotations(*gyroscope, window.timestamps_ns);
  if (source == RotationSource::truth) return {{R_wc_true.begin(), R_wc_true.end()}, ""};
  if (auto reason = reason_not_to_try(window)) return {{}, *reason};
  if (source == RotationSource::averaging) return averaged_rotations(window, stop);
  if (source == RotationSource::gyro_calibrated)
    return calibrated_gyro_rotations(*gyroscope, window, stop);
  const auto solver =
      source == RotationSource::direct ? RelativeSolver::eigensolver : RelativeSolver::five_point;
  return pair_rotations(window, {solver, ransac.threshold_px, ransac.seed}, stop);
}

}  // namespace

RotationSource first_source(RotationSource asked, bool has_gyroscope) {
  using enum RotationSource;
  if (asked == automatic) return has_gyroscope ? gyro_calibrated : five_point;
  if (asked == raw) return has_gyroscope ? gyro : averaging;
  return asked;
}

ChosenRotations chosen_rotations(const Window& window,
                                 const Gyroscope* gyroscope,
                                 std::span<const Eigen::Matrix3d> R_wc_true,
                                 RotationSource asked,
                                 const RansacOptions& ransac,
                                 const std::stop_token& stop) {
  const auto from = [&](RotationSource source) {
    return rotations_from(window, gyroscope, R_wc_true, source, ransac, stop);
  };
  const RotationSource first = first_source(asked, gyroscope != nullptr);
  ChosenRotations chosen{first, from(first)};
  chosen.note = chosen.rotations.note;
  const bool settled = !chosen.rotations.R_wc.empty() || chosen.rotations.stopped;
  if (asked != RotationSource::automatic || settled) return chosen;
  chosen.note = chosen.rotations.reason;
  chosen.source = gyroscope != nullptr ? RotationSource::gyro : RotationSource::averaging;
  chosen.rotations = from(chosen.source);
  if (!chosen.rotations.note.empty()) chosen.note += "; " + chosen.rotations.note;
  return chosen;
}

}  // namespace gpo
