// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/calibration/plane/plane_adjustment.h"

#include <functional>
#include <vector>

namespace gpo {

// These functions drop observations. Points and views keep their indices, so that an adjustment
// remains valid. A view may be left without a point.

/// Returns the planes without points in fewer than 3 views, views of fewer than 8 points, and
/// planes without observations.
std::vector<ObservedPlane> cleaned(std::vector<ObservedPlane> planes);

/// Returns the observations for which `is_kept(plane, view, column)`, without points in fewer than
/// 3 views and without views of fewer than 8 points.
std::vector<ObservedPlane> filtered(
    std::vector<ObservedPlane> planes,
    const std::function<bool(std::size_t plane, std::size_t view, int column)>& is_kept);

/// Returns a few views, spread evenly, and some of their points: enough to compare starts.
std::vector<ObservedPlane> thinned(const std::vector<ObservedPlane>& planes);

/// Returns the planes without errors above `most_px`, and without views with more than three times
/// the median error of all views. Appends the frames of the latter to `left_out`.
std::vector<ObservedPlane> without_far(const std::vector<ObservedPlane>& planes,
                                       const ViewErrors& errors,
                                       double most_px,
                                       std::vector<int>& left_out);

std::vector<double> finite(const ViewErrors& errors);
/// Noise of a coordinate [px], by the median error.
double noise_of(const ViewErrors& errors);

/// Distance of points from their planes, by the median of the observed ones [distances].
double height_of(const std::vector<ObservedPlane>& planes, const Adjustment& adjustment);

int observation_count(const std::vector<ObservedPlane>& planes);
int view_count(const std::vector<ObservedPlane>& planes);   ///< with at least one point
int point_count(const std::vector<ObservedPlane>& planes);  ///< in at least one view

}  // namespace gpo
