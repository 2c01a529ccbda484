// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/self_calibration.h"

#include "engine/calibration/plane_views/gyro_rotations.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gpo {
namespace {

constexpr int kLeastReferences = 1;

/// Those through which a plane was followed longest.
std::vector<PlaneChain> longest(std::vector<PlaneChain> chains, int most) {
  std::erase_if(chains, [](const PlaneChain& chain) {
    return std::ssize(chain.references) < kLeastReferences;
  });
  std::ranges::stable_sort(chains, [](const PlaneChain& a, const PlaneChain& b) {
    return a.H_i_first.size() > b.H_i_first.size();
  });
  if (std::ssize(chains) > most) chains.resize(most);
  return chains;
}

}  // namespace

SelfCalibration calibrate_from_plane(const FrameCache& images,
                                     const Camera& guess,
                                     const Gyroscope* gyroscope,
                                     std::span<const std::int64_t> frame_times_ns,
                                     const SelfCalibrationOptions& options,
                                     const CalibrationProgress& progress,
                                     const std::stop_token& stop) {
  const auto told = [&](const char* what) {
    return [&progress, what](int done, int of) {
      if (progress) progress(what, done, of);
    };
  };
  SelfCalibration result;
  ChainImages chained{[&](int frame) { return images.gray(frame); },
                        images.count(),
                        1 + (images.count() - 1) / options.most_frames,
                        told("following a plane"),
                        stop};
  result.frames = (chained.frames + chained.step - 1) / chained.step;
  const Camera bent = with_likely_bend(chained, guess, options.chain);
  const auto chains = longest(plane_chains(chained, bent, options.chain), options.most_planes);
  result.chains = static_cast<int>(chains.size());
  std::vector<ObservedPlane> planes;
  LinkOptions link = options.link;
  link.most_images /= std::max(1, std::min(2, result.chains));
  for (int k = 0; k < result.chains && !stop.stop_requested(); ++k) {
    told("finding its points again")(k, result.chains);
    planes.push_back(linked_views(chained, chains[k], bent, link));
  }
  GyroRotations rotations;
  if (gyroscope != nullptr) rotations = gyro_rotations(*gyroscope, frame_times_ns, planes);
  result.gyroscope = !rotations.rotations.empty();
  result.lens =
      lens_from_planes(std::move(planes), rotations, bent, options.lens, told("the lens"), stop);
  return result;
}

}  // namespace gpo
