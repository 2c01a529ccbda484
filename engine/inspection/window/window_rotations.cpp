// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/window/window_rotations.h"

#include "engine/base/error.h"

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

}  // namespace

std::string why_no_rotations(const Recording& recording, RotationSource source) {
  if (needs_gyroscope(source) && !recording.gyroscope) return recording.name + " has no gyroscope";
  const bool truth = recording.truth || (recording.board && recording.images);
  if (source == RotationSource::truth && !truth)
    return recording.name + " has no ground truth, and no pictures of a board to compute it from";
  return "";
}

RotationSource rotation_source_used(const Recording& recording, RotationSource asked) {
  const RotationSource first = first_source(asked, recording.gyroscope.has_value());
  if (first != asked) return first;
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
  const RotationSource first = rotation_source_used(recording, asked);
  std::vector<Eigen::Matrix3d> R_wc_true;
  if (first == RotationSource::truth) R_wc_true = true_rotations(truth, window.start);
  const Gyroscope* gyroscope = recording.gyroscope ? &*recording.gyroscope : nullptr;
  return chosen_rotations(window, gyroscope, R_wc_true, asked, ransac, stop);
}

}  // namespace gpo
