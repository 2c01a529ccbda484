// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Exchanges Eigen's objects with the library in both directions and frees and resizes those of the
// library. tests/flags/run.sh compiles it with flags that change Eigen's alignment.
#include <iostream>
#include <vector>

#include <gpo/diagnosis/diagnosis.h>
#include <gpo/geometry.h>
#include <gpo/live.h>
#include <gpo/result.h>
#include <gpo/solvers.h>

namespace {

/// Views of a plane in front of a camera that moves to the right and down.
std::vector<gpo::Frame> frames_of_plane(const gpo::Camera& camera) {
  std::vector<gpo::Frame> frames(12);
  for (int i = 0; i < 12; ++i) {
    frames[i].timestamp_ns = i * 33'333'333LL;
    frames[i].raw_px.resize(2, 60);
    for (int j = 0; j < 60; ++j) {
      const Eigen::Vector3d p(
          (j % 10 - 4.5) / 5 - 0.05 * i, (j / 10 - 2.5) / 3 - 0.01 * i, 2 - 0.02 * i);
      frames[i].ids.push_back(j);
      frames[i].raw_px.col(j) << camera.fx * p.x() / p.z() + camera.cx,
          camera.fy * p.y() / p.z() + camera.cy;
    }
  }
  return frames;
}

bool is_right(const gpo::Initialization& result) {
  if (!result.ok) std::cerr << result.reason << '\n';
  return result.ok && (result.plane.normal + Eigen::Vector3d::UnitZ()).norm() < 1e-3 &&
         result.uncertainty && result.uncertainty->noise.normal.allFinite();
}

/// Eigen's product of large matrices needs buffers with the alignment of its vectors.
bool multiplies() {
  const Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(101, 101);
  return ((ones * ones).array() == 101).all();
}

/// Reallocates here what the library allocated.
void resize(gpo::WindowResult& result) {
  for (Eigen::Matrix2Xd& points : result.window.points_px)
    points.conservativeResize(2, points.cols() + 5);
  result.initialization.uncertainty->joint_covariance.resize(9, 9);
}

}  // namespace

int main() {
  const gpo::Camera camera{.width = 640, .height = 480, .fx = 500, .fy = 500, .cx = 320, .cy = 240};
  const std::vector<gpo::Frame> frames = frames_of_plane(camera);
  gpo::WindowResult result = gpo::initialize(camera, frames);
  if (!is_right(result.initialization) || !multiplies()) return 1;
  gpo::Window window = result.window;
  resize(result);
  for (const gpo::Method& method : gpo::methods())
    if (!is_right(gpo::assessed(method, window, method.initialize(window, {}, {})))) return 1;

  gpo::LiveInitializer live(camera, {.initialize = {.lens = gpo::Lens::exact}});
  for (const gpo::Frame& frame : frames) live.add_frame(frame);
  const gpo::LiveStatus status = live.wait();
  return status.answer && is_right(status.answer->initialization) ? 0 : 1;
}
