// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/geometry/camera.h"

namespace gpo {

/// What most cameras see along the diagonal of their pictures, where nobody says more [deg].
inline constexpr double kUsualView_deg = 70;

/// A pinhole camera whose focal length is so many diagonals of its pictures, its axis in the
/// middle.
Camera camera_of_focal(int width, int height, double focal_diagonals);

/// One that sees so much along the diagonal.
Camera camera_of_view(int width, int height, double diagonal_deg = kUsualView_deg);

}  // namespace gpo
