// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// The pieces of a polyline that lie under a pattern of lengths, drawn and left out in turn, over
/// and over. Bends within a piece are kept: two points a straight piece.
std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> dashes_along(
    std::span<const Eigen::Vector2d> line, std::span<const double> pattern);

}  // namespace gpo
