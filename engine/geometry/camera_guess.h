// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

namespace gpo {

/// What most cameras see along the diagonal of their pictures, where nobody says more [deg].
inline constexpr double kUsualView_deg = 70;

/// A pinhole camera that sees so much along the diagonal of its pictures, its axis in the middle.
Camera camera_of_view(int width, int height, double diagonal_deg = kUsualView_deg);

}  // namespace gpo
