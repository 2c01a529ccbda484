// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tests/engine/methods/perturbed_truth.h"

#include <random>

#include <Eigen/Geometry>

namespace gpo::test {

Initialization perturbed_truth(const Simulation& truth, const Perturbation& perturbation) {
  std::mt19937_64 random(perturbation.seed);
  std::normal_distribution<double> gaussian;
  const auto vector = [&]() {
    return Eigen::Vector3d(gaussian(random), gaussian(random), gaussian(random));
  };
  Initialization start;
  start.ok = true;
  const Eigen::Vector3d axis = truth.plane.normal.cross(vector()).normalized();
  start.plane = {so3_exp(radians(perturbation.normal_deg) * axis) * truth.plane.normal, 1};
  start.cameras = truth.cameras;
  for (std::size_t i = 1; i < start.cameras.size(); ++i) {
    Pose& camera = start.cameras[i];
    camera.R_wc = camera.R_wc * so3_exp(radians(perturbation.rotation_deg) * vector());
    camera.p_wc += perturbation.position * vector();
  }
  return start;
}

}  // namespace gpo::test
