// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/simulated_room.h"

#include "engine/geometry/camera.h"
#include "engine/planes/inliers.h"

#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace gpo::test {

using Eigen::Vector2d, Eigen::Vector3d;

namespace {

void use_true_planes(Room& room) {
  Window& window = room.window;
  window.planes.clear();
  for (int k = 0; k < static_cast<int>(room.planes.size()); ++k) {
    WindowPlane plane;
    std::vector<bool> on(window.track_count(), false);
    for (int j = 0; j < window.track_count(); ++j) {
      if (room.plane_of_track[j] != k) continue;
      plane.tracks.push_back(j);
      on[j] = true;
    }
    for (const Pose& camera : room.cameras) {
      const Eigen::Matrix3d A =
          Eigen::Matrix3d::Identity() + camera.p_wc * room.planes[k].transpose();
      plane.H_i1.emplace_back(window.K * camera.R_wc.transpose() * A * window.K.inverse());
      plane.inlier.push_back(on);
    }
    window.planes.push_back(std::move(plane));
  }
  window.leader = 0;
  window.H_i1 = window.planes[0].H_i1;
  window.inlier = window.planes[0].inlier;
}

}  // namespace

std::vector<Vector3d> floor_and_walls() {
  const auto plane = [](const Vector3d& normal, double distance) -> Vector3d {
    return normal.normalized() / distance;
  };
  return {plane({0, -1, -0.5}, 1), plane({0.1, 0.3, -1}, 2.2), plane({-1, 0.1, -0.4}, 1.3)};
}

Room simulate_room(const RoomOptions& options) {
  const Simulation base = simulate({.motion = options.motion,
                                    .frames = options.frames,
                                    .points = 8,
                                    .noise_px = 0,
                                    .travel = options.travel,
                                    .seed = options.seed});
  Room room{{}, base.cameras, options.planes, {}};
  const Eigen::Matrix3d K = base.window.K;
  const Camera camera{
      .width = 640, .height = 480, .fx = K(0, 0), .fy = K(1, 1), .cx = K(0, 2), .cy = K(1, 2)};
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> u(20, 620), v(20, 460), share(0, 1);
  std::uniform_real_distribution<double> inverse(1 / options.farthest, 1 / options.nearest);
  std::normal_distribution<double> noise;
  Tracks tracks;
  tracks.raw_px.assign(options.frames, Eigen::Matrix2Xd(2, options.tracks));
  while (static_cast<int>(tracks.ids.size()) < options.tracks) {
    // One by one, as compilers evaluate arguments in any order.
    const double at_v = v(random), at_u = u(random);
    const Vector3d ray = K.inverse() * Vector3d(at_u, at_v, 1);
    int plane = -1;
    double at = share(random);
    for (int k = 0; k < static_cast<int>(options.shares.size()) && plane < 0; ++k) {
      if (at < options.shares[k]) plane = k;
      at -= options.shares[k];
    }
    const double rho = plane >= 0        ? -options.planes[plane].dot(ray)
                       : options.surface ? options.surface(ray)
                                         : inverse(random);
    if (!(rho >= 0.1)) continue;
    const auto j = static_cast<Eigen::Index>(tracks.ids.size());
    for (int i = 0; i < options.frames; ++i) {
      const Vector2d px = (K * to_camera(base.cameras[i], ray / rho)).hnormalized();
      const double noise_v = noise(random), noise_u = noise(random);
      tracks.raw_px[i].col(j) = px + options.noise_px * Vector2d(noise_u, noise_v);
    }
    tracks.ids.push_back(j);
    room.plane_of_track.push_back(plane);
  }
  room.window = make_window(tracks,
                            camera,
                            base.window.timestamps_ns,
                            {.ransac = {.seed = options.seed}, .inliers = Inliers::planes});
  for (int i = 0; i < options.frames; ++i) room.window.R_wc[i] = base.cameras[i].R_wc;
  if (options.known_exactly) use_true_planes(room);
  return room;
}

}  // namespace gpo::test
