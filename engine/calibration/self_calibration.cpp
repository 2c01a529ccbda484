// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/self_calibration.h"

#include "engine/calibration/plane/plane_chain.h"
#include "engine/frontend/rotations.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace gpo {
namespace {

constexpr int kMostFrames = 400;
constexpr std::size_t kMostPlanes = 4;  // the longest chains
constexpr int kMostChainViews = 60;     // for one chain; half of it for more
// Noise of a rotation and scale error of the rates, as phones have them.
constexpr double kGyroNoise_rad = 3e-4;
constexpr double kGyroScale = 3e-3;

/// Rotations between successive views of a plane, where the gyroscope's samples cover them.
GyroRotations gyro_rotations_between(const TimedGyroscope& timed,
                                     const std::vector<ObservedPlane>& planes) {
  const Gyroscope& gyroscope = *timed.gyroscope;
  GyroRotations gyro;
  gyro.bias_sigma_rad_s = gyroscope.bias_sigma_rad_s;
  for (const ObservedPlane& plane : planes) {
    for (std::size_t i = 1; i < plane.views.size(); ++i) {
      const int from = plane.views[i - 1].frame;
      const int to = plane.views[i].frame;
      const std::array times{timed.frame_times_ns[from], timed.frame_times_ns[to]};
      const std::int64_t offset_ns = gyroscope.time_offset_ns;
      if (!why_not_covered(gyroscope, times[0] + offset_ns, times[1] + offset_ns).empty()) continue;
      const Rotations rotation = sensitive_gyro_rotations(gyroscope, times);
      const double sigma_rad =
          std::hypot(kGyroNoise_rad, kGyroScale * so3_log(rotation.R_wc[1]).norm());
      gyro.rotations.push_back({from, to, rotation.R_wc[1], rotation.gyro->d_bias[1], sigma_rad});
    }
  }
  return gyro;
}

}  // namespace

SelfCalibration calibrate_from_plane(const FrameCache& images,
                                     const Camera& guess,
                                     const TimedGyroscope& timed,
                                     const CalibrationProgress& progress,
                                     const std::stop_token& stop) {
  const auto step = [&](const char* what) {
    return [&progress, what](int done, int of) {
      if (progress) progress(what, done, of);
    };
  };
  const ChainImages chained{[&](int frame) { return images.gray(frame); },
                            images.count(),
                            1 + (images.count() - 1) / kMostFrames,
                            step("following a plane"),
                            stop};
  const Camera distorted = with_likely_distortion(chained, guess);
  std::vector<PlaneChain> chains = plane_chains(chained, distorted);
  std::erase_if(chains, [](const PlaneChain& chain) { return chain.references.empty(); });
  std::ranges::stable_sort(
      chains, std::greater{}, [](const PlaneChain& chain) { return chain.H_i_first.size(); });
  if (chains.size() > kMostPlanes) chains.resize(kMostPlanes);
  std::vector<ObservedPlane> planes;
  const int count = static_cast<int>(chains.size());
  for (int k = 0; k < count && !stop.stop_requested(); ++k) {
    step("finding its points in other images")(k, count);
    planes.push_back(
        linked_views(chained, chains[k], distorted, kMostChainViews / std::min(2, count)));
  }
  GyroRotations gyro;
  if (timed.gyroscope != nullptr) gyro = gyro_rotations_between(timed, planes);
  PlaneLens lens =
      lens_from_planes(std::move(planes), gyro, distorted, step("estimating the lens"), stop);
  return {std::move(lens), !gyro.rotations.empty()};
}

}  // namespace gpo
