// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Runs GPO on a synthetic window with gpo::core only: a camera moves sideways over a plane.
#include <iostream>

#include <Eigen/LU>
#include <gpo/diagnosis/diagnosis.h>
#include <gpo/geometry.h>
#include <gpo/solvers.h>
#include <gpo/version.h>

int main() {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.5, -1).normalized();
  gpo::Window window;
  window.K << 500, 0, 320, 0, 500, 240, 0, 0, 1;
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d tau(-0.03 * i, 0.002 * i * i, 0);  // minus the camera's position, d = 1
    const Eigen::Matrix3d H =
        window.K * (Eigen::Matrix3d::Identity() - tau * normal.transpose()) * window.K.inverse();
    Eigen::Matrix2Xd points(2, 48);
    for (int j = 0; j < 48; ++j)
      points.col(j) = gpo::transfer(H, Eigen::Vector2d(60 + 70 * (j % 8), 60 + 70 * (j / 8)));
    window.timestamps_ns.push_back(i * 33'333'333LL);
    window.points_px.push_back(points);
    window.inlier.emplace_back(48, true);
    window.H_i1.push_back(H);
    window.R_wc.push_back(Eigen::Matrix3d::Identity());
  }
  const gpo::Method& method = gpo::find_method("gpo");
  const auto result = gpo::assessed(method, window, method.initialize(window, {}, {}));
  if (!result.ok) std::cerr << result.reason << '\n';
  if (!result.ok) return 1;
  std::cout << "gpo " << GPO_VERSION_MAJOR << ": off by " << (result.plane.normal - normal).norm()
            << " rad; " << result.verdict->reason << '\n';
  return (result.plane.normal - normal).norm() < 1e-6 ? 0 : 1;
}
