// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/frontend/inliers.h"
#include "engine/initialize.h"

namespace gpo {

// The values that options get which are left to the method. Each function throws InputError for an
// unknown method.

/// Returns whether tracks off the plane are rejected. By default on for the methods that need a
/// plane and off for those that use all tracks (ba, pnp_ba).
bool uses_ransac(const InitializeOptions& options);

/// Returns how inliers are selected.
Inliers inliers_used(const InitializeOptions& options);

/// Returns when gravity is found. Only a method whose uncertainty is that of the very problem that
/// it solved, planes and cameras together, takes it into its solution; others get it afterwards.
Gravity gravity_used(const InitializeOptions& options);

/// Returns how a window is made. A method that needs no plane gets its start from the tracks on it
/// even where it then uses all.
RansacOptions ransac_options(const InitializeOptions& options);

}  // namespace gpo
