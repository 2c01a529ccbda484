// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/initializers/plane_observations.h"

#include "engine/initializers/plane_kernel.h"

namespace gpo {
namespace {

void push(FrameObservations& f, double x, double y, double u, double v, double mask) {
  f.ray_x.push_back(x);
  f.ray_y.push_back(y);
  f.u.push_back(u);
  f.v.push_back(v);
  f.mask.push_back(mask);
}

void reserve(FrameObservations& f, std::size_t size) {
  for (auto* array : {&f.ray_x, &f.ray_y, &f.u, &f.v, &f.mask}) array->reserve(size);
}

}  // namespace

int PlaneObservations::count() const {
  int sum = 0;
  for (const FrameObservations& frame : frames) sum += frame.count;
  return sum;
}

FrameObservations frame_observations(const Window& window, int frame) {
  FrameObservations f;
  if (frame == 0) return f;
  const Eigen::Matrix3d& K = window.K;
  const Eigen::Matrix2Xd& from = window.points_px[0];
  const Eigen::Matrix2Xd& to = window.points_px[frame];
  const double to_x = 1 / K(0, 0);
  const double to_y = 1 / K(1, 1);
  reserve(f, window.track_count() + kKernelWidth);
  for (int j = 0; j < window.track_count(); ++j) {
    if (!window.inlier[frame][j]) continue;
    push(f,
         to_x * (from(0, j) - K(0, 2)),
         to_y * (from(1, j) - K(1, 2)),
         to(0, j) - K(0, 2),
         to(1, j) - K(1, 2),
         1);
    ++f.count;
  }
  while (f.count > 0 && f.u.size() % kKernelWidth != 0)
    push(f, f.ray_x[0], f.ray_y[0], f.u[0], f.v[0], 0);
  return f;
}

PlaneObservations plane_observations(const Window& window) {
  PlaneObservations observations{window.K(0, 0), window.K(1, 1), {}};
  for (int i = 0; i < window.frame_count(); ++i)
    observations.frames.push_back(frame_observations(window, i));
  return observations;
}

}  // namespace gpo
