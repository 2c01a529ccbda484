// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/inspection/plane_names.h"

#include "engine/base/error.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kMostSigmaDeg = 15;  // for a tilt that gives a name
constexpr double kLevelDeg = 5;       // floors and furniture are not more level than that
constexpr double kSameHeight = 0.95;  // share of the floor's depth: a carpet, not a table

double normal_sigma_deg(const Initialization& result, const PlaneEstimate& plane) {
  if (plane.normal_covariance) return degrees(std::sqrt(plane.normal_covariance->trace()));
  return result.uncertainty ? result.uncertainty->normal_sigma_deg : 0;
}

/// Returns the estimated planes, or the leading one for a method that estimates only that.
std::vector<PlaneEstimate> found_planes(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  if (!result.planes.empty()) return result.planes;
  return {PlaneEstimate{.number = inspection.window->leader, .plane = result.plane}};
}

PlaneName named(const Initialization& result,
                const PlaneEstimate& plane,
                const InertialAlignment& inertial) {
  PlaneName found;
  found.tilt_deg = angle_deg(plane.plane.normal, Eigen::Vector3d(-inertial.gravity_m_s2));
  found.sigma_deg = std::hypot(normal_sigma_deg(result, plane), inertial.gravity_sigma_deg);
  const double within = std::max(kLevelDeg, 2 * found.sigma_deg);
  const auto near = [&](double tilt_deg) { return std::abs(found.tilt_deg - tilt_deg) <= within; };
  found.name = near(0) ? "floor" : near(180) ? "ceiling" : near(90) ? "wall" : "slanted";
  return found;
}

}  // namespace

std::optional<PlaneName> plane_name(const Inspection& inspection, int number) {
  const Initialization& result = *inspection.initialization;
  if (!result.ok || !inspection.inertial || !inspection.inertial->ok) return std::nullopt;
  std::optional<PlaneName> found;
  double depth = 0, deepest = 0;
  for (const PlaneEstimate& plane : found_planes(inspection)) {
    const PlaneName name = named(result, plane, *inspection.inertial);
    if (name.sigma_deg > kMostSigmaDeg) continue;
    if (name.name == "floor") deepest = std::max(deepest, plane.plane.distance);
    if (plane.number != number) continue;
    found = name;
    depth = plane.plane.distance;
  }
  if (found && found->name == "floor" && depth < kSameHeight * deepest) found->name = "table";
  return found;
}

std::string plane_title(const Inspection& inspection, int number) {
  const auto found = plane_name(inspection, number);
  return fmt::format("plane {}{}", number + 1, found ? " (" + found->name + ")" : "");
}

std::optional<double> known_scale(const Inspection& inspection) {
  if (!inspection.inertial || !inspection.inertial->ok || !inspection.inertial->scale_known)
    return std::nullopt;
  return inspection.inertial->scale;
}

double meters_per_unit(const Inspection& inspection) {
  if (const auto scale = known_scale(inspection)) return *scale;
  const auto& inertial = inspection.inertial;
  throw InputError(fmt::format("meters: the scale is unknown ({})",
                               !inertial      ? "no accelerometer is used"
                               : inertial->ok ? inertial->scale_reason
                                              : inertial->reason));
}

}  // namespace gpo
