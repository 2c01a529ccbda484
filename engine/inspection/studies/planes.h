// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/inspection/inspection.h"
#include "engine/methods/initializers.h"
#include "engine/methods/plane/normal_landscape.h"

namespace gpo {

/// Name of a plane by its orientation to gravity.
struct PlaneName {
  /// floor: level, below the cameras, and the lowest such plane of the window; table: level, above
  /// the floor; ceiling: level, above the cameras; wall: upright; slanted.
  std::string name;
  double tilt_deg = 0;   ///< angle of its normal (towards the cameras) from up: 0 floor, 90 wall
  double sigma_deg = 0;  ///< uncertainty of the tilt (1 sigma), from the normal and from gravity
};

/// Returns the name of a plane by its number in the window; nullopt if gravity or the plane is
/// unknown or less certain than 15 deg.
std::optional<PlaneName> plane_name(const Inspection& inspection, int number);

/// Returns "plane 2 (wall)", or "plane 2" without a name.
std::string plane_title(const Inspection& inspection, int number);

/// Returns the meters per unit of the estimate; nullopt if the accelerometer does not determine
/// them.
std::optional<double> known_scale(const Inspection& inspection);
/// Returns the same; throws InputError with the reason if it is unknown.
double meters_per_unit(const Inspection& inspection);

/// Extent of a plane other than the leading one, in the estimate's world.
struct PlanePatch {
  int number = 0;  ///< plane number in the window
  Eigen::Vector3d normal;
  std::array<Eigen::Vector3d, 4> corners = {};
  std::vector<MapPoint> points;
};

/// Returns the patches of all further planes of a successful initialization.
std::vector<PlanePatch> plane_patches(const Inspection& inspection);

/// Returns the patch of a refused solution's plane; nullopt if none of its tracks meets it.
std::optional<PlanePatch> refused_patch(const Inspection& inspection);

/// Evidence of a window on the plane's normal, independent of the method. Immutable.
struct NormalStudy {
  std::shared_ptr<const Window> window;
  NormalLandscape landscape;
  std::vector<std::vector<HomographyCandidate>> candidates;  ///< one a frame of the window
  std::vector<NormalCluster> clusters;                       ///< over the whole window's candidates
  std::string error = {};  ///< why it failed, one line; then only `window` is set
};

/// Returns the study; null if stopped. Throws InputError for bad input.
std::shared_ptr<const NormalStudy> study_normals(const Inspection& inspection,
                                                 const std::stop_token& stop = {});

/// Returns the true normal in the reference camera, towards it; nullopt if unknown.
std::optional<Eigen::Vector3d> true_normal(const Inspection& inspection);

}  // namespace gpo
