// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/initialize.h"
#include "engine/planes/inliers.h"

namespace gpo {

// Values of options that are left to the method. Each function throws InputError for an unknown
// one.

/// Returns whether tracks off the plane are rejected. By default on for the methods that need a
/// plane and off for those that use all tracks (ba, pnp_ba).
bool uses_ransac(const InitializeOptions& options);

/// Returns how inliers are selected.
Inliers inliers_used(const InitializeOptions& options);

/// Returns when gravity is estimated: jointly only by a method whose uncertainty is that of the
/// problem that it solved, planes and cameras together; afterwards by all others.
Gravity gravity_used(const InitializeOptions& options);

/// Returns the priors of gravity and accelerometer.
InertialOptions inertial_options(const InitializeOptions& options);

/// Returns the RANSAC options of the window. A method that uses all tracks still starts from those
/// on the plane.
RansacOptions ransac_options(const InitializeOptions& options);

}  // namespace gpo
