// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/statistics.h"
#include "engine/inspection/rolling_cameras.h"
#include "engine/inspection/studies/studies.h"
#include "engine/methods/candidates/homography_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kMostSigmaDeg = 15;  // for a tilt that gives a name
constexpr double kLevelDeg = 5;       // floors and furniture are not more level than that
constexpr double kSameHeight = 0.95;  // share of the floor's depth: a carpet, not a table

/// A direction and its covariance [rad^2], rank 2.
struct Direction {
  Eigen::Vector3d unit;
  Eigen::Matrix3d covariance;

  /// Variance of the angle to another direction [rad^2].
  double variance_towards(const Eigen::Vector3d& other) const {
    const Eigen::Vector3d arc = (other - unit.dot(other) * unit).normalized();
    return arc.dot(covariance * arc);
  }
};

/// Returns one standard deviation of the angle between two directions [deg]: that along the arc
/// between them. If they are parallel, any change opens the angle.
double angle_sigma_deg(const Direction& a, const Direction& b) {
  const double any = std::sqrt(a.covariance.trace() + b.covariance.trace());
  constexpr double kParallel = 2;  // standard deviations
  if (a.unit.cross(b.unit).norm() <= std::sin(std::min(kParallel * any, radians(90))))
    return degrees(any);
  return degrees(std::sqrt(a.variance_towards(b.unit) + b.variance_towards(a.unit)));
}

PlaneName named(const PlaneEstimate& plane, const InertialAlignment& inertial) {
  PlaneName found;
  const Direction up{-inertial.gravity_m_s2.normalized(), inertial.direction_covariance};
  found.tilt_deg = angle_deg(plane.plane.normal, up.unit);
  // Without a covariance of this plane, that of the main plane would be too small.
  if (plane.normal_covariance)
    found.sigma_deg = angle_sigma_deg({plane.plane.normal, *plane.normal_covariance}, up);
  const double within = std::max(kLevelDeg, 2 * found.sigma_deg.value_or(0));
  const auto near = [&](double tilt_deg) { return std::abs(found.tilt_deg - tilt_deg) <= within; };
  found.name = near(0) ? "floor" : near(180) ? "ceiling" : near(90) ? "wall" : "slanted";
  return found;
}

using Eigen::Vector3d;

constexpr double kFarthest = 3;  // extent in median distances: excludes points near the horizon

std::vector<MapPoint> points_on(const Inspection& inspection,
                                const std::vector<int>& tracks,
                                const Plane& plane) {
  const RollingCamera reference = rolling_camera(inspection, 0);
  std::vector<MapPoint> points;
  for (const int j : tracks) {
    const Eigen::Vector2d raw_px = inspection.tracks->raw_px[0].col(j);
    if (const auto point = intersect(plane, Pose{}, reference, raw_px))
      points.push_back({j, *point});
  }
  if (points.empty()) return points;
  std::vector<double> distances;
  for (const MapPoint& point : points) distances.push_back(point.position.norm());
  const double most = kFarthest * median(std::move(distances));
  std::erase_if(points, [&](const MapPoint& point) { return point.position.norm() > most; });
  return points;
}

std::optional<PlanePatch> patch_of(const Inspection& inspection,
                                   int number,
                                   const std::vector<int>& tracks,
                                   const Plane& plane) {
  PlanePatch patch{
      .number = number, .normal = plane.normal, .points = points_on(inspection, tracks, plane)};
  if (patch.points.size() < 3) return std::nullopt;
  // The axis x is as near as possible to the image rows.
  Vector3d x = Vector3d::UnitX() - patch.normal.x() * patch.normal;
  if (x.norm() < 0.1) x = patch.normal.unitOrthogonal();
  x.normalize();
  const Vector3d y = patch.normal.cross(x);
  Eigen::AlignedBox2d box;
  for (const MapPoint& p : patch.points)
    box.extend(Eigen::Vector2d(x.dot(p.position), y.dot(p.position)));
  const Vector3d foot = -plane.distance * patch.normal;
  const auto at = [&](double u, double v) -> Vector3d { return foot + u * x + v * y; };
  patch.corners = {at(box.min().x(), box.min().y()),
                   at(box.max().x(), box.min().y()),
                   at(box.max().x(), box.max().y()),
                   at(box.min().x(), box.max().y())};
  return patch;
}

}  // namespace

std::vector<PlaneEstimate> found_planes(const Inspection& inspection) {
  const Initialization& result = *inspection.initialization;
  if (!result.planes.empty()) return result.planes;
  PlaneEstimate only{.number = inspection.window->leader, .plane = result.plane};
  if (result.uncertainty) only.normal_covariance = result.uncertainty->normal_covariance;
  return {only};
}

std::optional<PlaneName> plane_name(const Inspection& inspection, int number) {
  const Initialization& result = *inspection.initialization;
  if (!result.ok || !inspection.inertial || !inspection.inertial->ok) return std::nullopt;
  std::optional<PlaneName> found;
  double depth = 0, deepest = 0;
  for (const PlaneEstimate& plane : found_planes(inspection)) {
    const PlaneName name = named(plane, *inspection.inertial);
    if (name.sigma_deg.value_or(0) > kMostSigmaDeg) continue;
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

// They are green, lavender, reddish purple, blue and violet, which color-blind people distinguish.
std::uint32_t plane_color(int number) {
  constexpr std::array<std::uint32_t, 4> kOthers{0xB49CFF, 0xCC79A7, 0x4A7FD0, 0x7450E5};
  return number == 0 ? 0x1FCB93 : kOthers[(number - 1) % kOthers.size()];
}

std::vector<PlanePatch> plane_patches(const Inspection& inspection) {
  const Window& window = *inspection.window;
  std::vector<PlanePatch> patches;
  for (const PlaneEstimate& estimate : inspection.initialization->planes) {
    const int number = estimate.number;
    if (number == window.leader) continue;
    auto patch = patch_of(inspection, number, window.planes[number].tracks, estimate.plane);
    if (patch) patches.push_back(std::move(*patch));
  }
  return patches;
}

std::vector<PlanePatch> refused_patches(const Inspection& inspection) {
  const Initialization& failure = *inspection.initialization;
  std::vector<RefusedSolution> solutions;
  if (failure.ambiguity && !failure.ok) solutions = failure.ambiguity->undecided;
  if (solutions.empty() && failure.refused) solutions = {*failure.refused};
  const Window& window = *inspection.window;
  std::vector<PlanePatch> patches;
  for (const RefusedSolution& one : solutions)
    if (auto patch = patch_of(inspection, window.leader, window.inlier_tracks(0), one.plane))
      patches.push_back(std::move(*patch));
  return patches;
}

std::shared_ptr<const NormalStudy> study_normals(const Inspection& inspection,
                                                 const std::stop_token& stop) {
  constexpr int kSide = 96;  // cells of two degrees, narrower than the valley of a short window
  const Window& window = *inspection.window;
  auto landscape = normal_landscape(window, kSide, stop);
  auto candidates = candidates_of_window(window, stop);
  if (!landscape || stop.stop_requested()) return nullptr;
  auto clusters = normal_clusters(candidates);
  return std::make_shared<const NormalStudy>(NormalStudy{
      inspection.window, std::move(*landscape), std::move(candidates), std::move(clusters)});
}

std::optional<Eigen::Vector3d> true_normal(const Inspection& inspection) {
  const WindowTruth* truth = inspection.truth.get();
  if (truth == nullptr || !truth->plane || truth->cameras.empty() || !truth->cameras[0])
    return std::nullopt;
  const Eigen::Vector3d normal = truth->cameras[0]->R_wc.transpose() * truth->plane->normal;
  return normal.z() > 0 ? -normal : normal;
}

}  // namespace gpo
