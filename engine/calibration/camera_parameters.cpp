// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/calibration/camera_parameters.h"

namespace gpo {

std::vector<std::string> parameter_names(const Camera& camera) {
  std::vector<std::string> names = {"fx", "fy", "cx", "cy", "k1", "k2"};
  if (camera.distortion == Distortion::equidistant) {
    names.insert(names.end(), {"k3", "k4"});
  } else {
    names.insert(names.end(), {"p1", "p2", "k3", "k4", "k5", "k6"});
  }
  names.resize(4 + camera.coefficients.size());
  return names;
}

std::vector<double> parameters(const Camera& camera) {
  std::vector<double> values = {camera.fx, camera.fy, camera.cx, camera.cy};
  values.insert(values.end(), camera.coefficients.begin(), camera.coefficients.end());
  return values;
}

}  // namespace gpo
