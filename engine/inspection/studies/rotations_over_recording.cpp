// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/studies/rotations_over_recording.h"

#include "engine/geometry/decompositions.h"
#include "engine/geometry/statistics.h"
#include "engine/inspection/inspector.h"
#include "engine/methods/certainty/window_evidence.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

constexpr double kWindow_s = 0.3;
constexpr int kFewestFrames = 5;
constexpr int kMostFrames = 20;
constexpr double kOnlyRotates = 1.5;  // residual of rotations to that of homographies

int window_frames(const Recording& recording) {
  std::vector<double> periods_s;
  for (int i = 1; i < recording.frame_count(); ++i)
    periods_s.push_back(
        1e-9 * static_cast<double>(recording.timestamps_ns[i] - recording.timestamps_ns[i - 1]));
  const int frames = 1 + static_cast<int>(std::lround(kWindow_s / median(periods_s)));
  return std::clamp(frames, kFewestFrames, kMostFrames);
}

/// Returns R_wc with K R_cw K^-1 nearest to each homography; empty if one is missing.
std::vector<Eigen::Matrix3d> rotations_of_homographies(const Window& window) {
  std::vector<Eigen::Matrix3d> R_wc{Eigen::Matrix3d::Identity()};
  for (int i = 1; i < window.frame_count(); ++i) {
    if (!window.H_i1[i].allFinite()) return {};
    Eigen::Matrix3d M = window.K.inverse() * window.H_i1[i] * window.K;
    if (M.determinant() < 0) M = -M;
    R_wc.emplace_back(nearest_rotation(M).transpose());
  }
  return R_wc;
}

bool only_rotates(const Window& window) {
  const WindowEvidence evidence = evidence_of(window);
  return evidence.rotation_rms_px() < kOnlyRotates * evidence.noise_px();
}

std::vector<Eigen::Matrix3d> rotations_of(const Inspection& inspection) {
  const Window& window = *inspection.window;
  const Initialization& result = *inspection.initialization;
  const bool of_all_tracks = inspection.rotations_used == RotationSource::five_point;
  if (result.ok && !of_all_tracks) {
    std::vector<Eigen::Matrix3d> R_wc;
    for (const Pose& camera : result.cameras)
      R_wc.emplace_back(result.cameras[0].R_wc.transpose() * camera.R_wc);
    return R_wc;
  }
  // Rotations that could not be determined are I in all frames.
  const bool determined =
      std::ranges::any_of(window.R_wc, [](const auto& R) { return !R.isIdentity(0); });
  if (determined) return window.R_wc;
  if (only_rotates(window)) return rotations_of_homographies(window);
  return {};
}

}  // namespace

std::vector<ImageRotations> rotations_over_recording(
    const std::shared_ptr<const Recording>& recording,
    int most_windows,
    const std::function<void(int, int)>& progress,
    const std::stop_token& stop) {
  auto images_only = std::make_shared<Recording>(*recording);
  images_only->gyroscope.reset();
  images_only->truth.reset();
  images_only->board.reset();
  Inspector inspector(images_only);
  Settings settings;
  settings.frames = std::min(window_frames(*recording), recording->frame_count());
  const int step = settings.frames - 1;
  const int fit = std::max(1, (recording->frame_count() - 1) / std::max(1, step));
  const int count = std::min(fit, most_windows);
  std::vector<ImageRotations> windows;
  for (int w = 0; w < count && !stop.stop_requested(); ++w) {
    settings.start = step * static_cast<int>(static_cast<std::int64_t>(w) * fit / count);
    const auto inspection = inspector.inspect(settings, stop);
    if (!inspection) break;
    auto R_wc = rotations_of(*inspection);
    if (!R_wc.empty()) windows.push_back({inspection->window->timestamps_ns, std::move(R_wc)});
    if (progress) progress(w + 1, count);
  }
  return windows;
}

}  // namespace gpo
