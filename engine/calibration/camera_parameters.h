// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

#include <string>
#include <vector>

namespace gpo {

/// Names of what is calibrated of a camera, in order: "fx", ..., "k1", ...
std::vector<std::string> parameter_names(const Camera& camera);
/// Their values.
std::vector<double> parameters(const Camera& camera);

}  // namespace gpo
