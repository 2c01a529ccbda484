// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"
#include "engine/calibration/plane/plane_views.h"
#include "engine/calibration/plane/plane_start.h"

#include <vector>

namespace gpo {

// What is dropped goes from the sights; points and sights keep their numbers, so that an adjustment
// stays one of what is left. A sight may be left without a point.

/// Without points that fewer than 3 sights show, and all of sights that show fewer than 8.
std::vector<ObservedPlane> cleaned(std::vector<ObservedPlane> planes);

/// Only what a mosaic places.
ObservedPlane placed_part(const ObservedPlane& plane, const PlaneMosaic& mosaic);

/// Without observations of what is behind the camera, whose errors are infinite.
std::vector<ObservedPlane> visible_part(std::vector<ObservedPlane> planes, const ViewErrors& errors);

/// A few sights, spread evenly, and of the points some everywhere: enough to compare starts.
std::vector<ObservedPlane> thinned(const std::vector<ObservedPlane>& planes);

/// Without observations that are farther off than `most_px`, and without sights whose median is
/// more than three times the median of all sights' (frames are added to `left_out`).
std::vector<ObservedPlane> without_far(const std::vector<ObservedPlane>& planes,
                                      const ViewErrors& errors,
                                      double most_px,
                                      std::vector<int>& left_out);

std::vector<double> finite(const ViewErrors& errors);
/// Noise of a coordinate [px], by the median of the errors' lengths.
double noise_of(const ViewErrors& errors);

/// How far points are off their planes, by the median of those that are seen [distances].
double height_of(const std::vector<ObservedPlane>& planes, const Adjustment& adjustment);

int observation_count(const std::vector<ObservedPlane>& planes);
int view_count(const std::vector<ObservedPlane>& planes);  ///< that show any point
int point_count(const std::vector<ObservedPlane>& planes);  ///< that are seen

}  // namespace gpo
