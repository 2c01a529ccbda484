// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/methods/plane/plane_observations.h"

namespace gpo {
namespace {

void resize(FrameObservations& f, std::size_t size) {
  for (auto* array : {&f.ray_x, &f.ray_y, &f.u, &f.v, &f.mask}) array->resize(size);
}

/// Whole vectors: what is missing are copies of the first inlier, of weight zero.
void pad(FrameObservations& f) {
  const std::size_t size = (f.count + kKernelWidth - 1) / kKernelWidth * kKernelWidth;
  resize(f, f.count);
  for (auto* array : {&f.ray_x, &f.ray_y, &f.u, &f.v})
    array->resize(size, array->empty() ? 0 : array->front());
  f.mask.resize(size, 0);
}

FrameObservations gathered(const Window& window, int frame, const std::vector<bool>& inlier) {
  FrameObservations f;
  if (frame == 0) return f;
  const Eigen::Matrix3d& K = window.K;
  const Eigen::Matrix2Xd& from = window.points_px[0];
  const Eigen::Matrix2Xd& to = window.points_px[frame];
  const double to_x = 1 / K(0, 0);
  const double to_y = 1 / K(1, 1);
  resize(f, window.track_count() + kKernelWidth);
  for (int j = 0; j < window.track_count(); ++j) {
    if (!inlier[j]) continue;
    f.ray_x[f.count] = to_x * (from(0, j) - K(0, 2));
    f.ray_y[f.count] = to_y * (from(1, j) - K(1, 2));
    f.u[f.count] = to(0, j) - K(0, 2);
    f.v[f.count] = to(1, j) - K(1, 2);
    f.mask[f.count] = 1;
    f.track.push_back(j);
    ++f.count;
  }
  pad(f);
  return f;
}

}  // namespace

int PlaneObservations::count() const {
  int sum = 0;
  for (const FrameObservations& frame : frames) sum += frame.count;
  for (const auto& plane : others)
    for (const FrameObservations& frame : plane) sum += frame.count;
  return sum;
}

FrameObservations frame_observations(const Window& window, int frame) {
  return gathered(window, frame, window.inlier[frame]);
}

PlaneObservations plane_observations(const Window& window, std::span<const int> others) {
  PlaneObservations observations{window.K(0, 0), window.K(1, 1), {}};
  for (int i = 0; i < window.frame_count(); ++i)
    observations.frames.push_back(frame_observations(window, i));
  for (const int plane : others) {
    auto& frames = observations.others.emplace_back();
    for (int i = 0; i < window.frame_count(); ++i)
      frames.push_back(gathered(window, i, window.planes[plane].inlier[i]));
  }
  return observations;
}

}  // namespace gpo
