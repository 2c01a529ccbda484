// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"
#include "engine/calibration/plane/plane_sights.h"
#include "engine/calibration/plane/plane_start.h"

#include <vector>

namespace gpo {

// What is dropped goes from the sights; points and sights keep their numbers, so that an adjustment
// stays one of what is left. A sight may be left without a point.

/// Without points that fewer than 3 sights show, and all of sights that show fewer than 8.
std::vector<SightedPlane> cleaned(std::vector<SightedPlane> planes);

/// Only what a mosaic places.
SightedPlane placed_part(const SightedPlane& plane, const PlaneMosaic& mosaic);

/// Without observations of what is behind the camera, whose errors are infinite.
std::vector<SightedPlane> visible_part(std::vector<SightedPlane> planes, const SightErrors& errors);

/// A few sights, spread evenly, and of the points some everywhere: enough to compare starts.
std::vector<SightedPlane> thinned(const std::vector<SightedPlane>& planes);

/// Without observations that are farther off than `most_px`, and without sights whose median is
/// more than three times the median of all sights' (frames are added to `left_out`).
std::vector<SightedPlane> without_far(const std::vector<SightedPlane>& planes,
                                      const SightErrors& errors,
                                      double most_px,
                                      std::vector<int>& left_out);

std::vector<double> finite(const SightErrors& errors);
/// Noise of a coordinate [px], by the median of the errors' lengths.
double noise_of(const SightErrors& errors);

/// How far points are off their planes, by the median of those that are seen [distances].
double height_of(const std::vector<SightedPlane>& planes, const Adjustment& adjustment);

int observation_count(const std::vector<SightedPlane>& planes);
int sight_count(const std::vector<SightedPlane>& planes);  ///< that show any point
int point_count(const std::vector<SightedPlane>& planes);  ///< that are seen

}  // namespace gpo
