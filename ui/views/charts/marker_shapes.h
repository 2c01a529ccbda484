// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The outline of a figure's marker around a point, of about equal weight to the eye: `index`
/// counts through circle, square, triangles, diamond, stars and crosses, over again beyond the
/// last.
std::vector<Eigen::Vector2d> marker_shape(int index, const Eigen::Vector2d& center, double size);

int marker_shape_count();

}  // namespace gpo
