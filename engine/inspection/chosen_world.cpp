// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/inspection/inspection.h"

#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kPickedSigma_px = 0.5;

/// A pixel of a frame of the window and the plane that it shows.
struct PickedPoint {
  int frame = 0;  ///< in the window
  Vector2d raw_px = Vector2d::Zero();
  int number = 0;  ///< number of the plane
  Plane plane = {};
};

/// Returns the point on its plane in the reference camera's world; nullopt if the ray misses it.
std::optional<Vector3d> position(const Inspection& inspection, const PickedPoint& point) {
  return point_on_plane(inspection, point.frame, point.raw_px, point.plane);
}

PickedPoint picked_point(const Inspection& inspection, int frame, const Vector2d& raw_px) {
  const Camera& camera = inspection.recording->camera;
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("point ({:g}, {:g}) {}", raw_px.x(), raw_px.y(), why));
  };
  const Vector2d size(camera.width, camera.height);
  if (raw_px.minCoeff() < -0.5 || (size - raw_px).minCoeff() < 0.5)
    refuse("is outside of the image");
  const auto number = plane_near(inspection, frame, raw_px);
  if (!number)
    refuse(fmt::format("is on no plane: none of a plane's tracks is within {:.0f} px",
                       kNearPlane * camera.width));
  const Plane* plane = estimated_plane(inspection, *number);
  if (plane == nullptr) refuse(fmt::format("is on plane {}, which has no estimate", *number + 1));
  PickedPoint point{frame, raw_px, *number, *plane};
  if (!position(inspection, point))
    refuse(fmt::format("is beyond the horizon of plane {}", *number + 1));
  return point;
}

/// Returns the points of a `PointPair`. Throws InputError if one is on no plane.
std::array<PickedPoint, 2> picked_points(const Inspection& inspection, const PointPair& pair) {
  const Window& window = *inspection.window;
  const int frame = pair.frame().value_or(window.start) - window.start;
  if (frame < 0 || frame >= window.frame_count())
    throw InputError(fmt::format("frame {} of the points is outside of the window {}-{}",
                                 frame + window.start,
                                 window.start,
                                 window.start + window.frame_count() - 1));
  return {picked_point(inspection, frame, pair.point(0)),
          picked_point(inspection, frame, pair.point(1))};
}

/// Errors of two points: of each plane its normal (3) and distance, of the camera's center (3), and
/// of both pixels (2 each). Points on the same plane share its errors.
constexpr int kErrors = 4 + 4 + 3 + 2 + 2;
using Errors = Eigen::Matrix<double, kErrors, 1>;

double length_with(const Inspection& inspection,
                   std::array<PickedPoint, 2> points,
                   const Errors& errors) {
  std::array<Vector3d, 2> at;
  const bool same = points[0].number == points[1].number;
  const Vector3d center = errors.segment<3>(8);
  for (int k = 0; k < 2; ++k) {
    const auto of_plane = errors.segment<4>(same ? 0 : 4 * k);
    PickedPoint& point = points[k];
    point.raw_px += errors.segment<2>(11 + 2 * k);
    point.plane.normal = (point.plane.normal + of_plane.head<3>()).normalized();
    // Moving the camera by c is moving the plane by -c, and the point back by c.
    point.plane.distance += of_plane[3] + point.plane.normal.dot(center);
    const auto found = position(inspection, point);
    if (!found) return std::nan("");
    at[k] = *found;
  }
  return (at[1] - at[0]).norm();
}

/// Covariance of a plane's normal (3) and distance (1).
Eigen::Matrix4d plane_covariance(const Inspection& inspection, int number) {
  const Initialization& result = *inspection.initialization;
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  if (number == inspection.window->leader) {
    const Uncertainty& u = *result.uncertainty;
    // The verdict's normal includes the lens.
    const double wider = normal_sigma_deg(inspection).value_or(0) / u.normal_sigma_deg;
    const double factor = std::isfinite(wider) ? std::max(1.0, wider * wider) : 1;
    covariance.topLeftCorner<3, 3>() = factor * u.normal_covariance;
  }
  for (const PlaneEstimate& plane : result.planes) {
    if (plane.number != number || number == inspection.window->leader) continue;
    if (plane.normal_covariance) covariance.topLeftCorner<3, 3>() = *plane.normal_covariance;
    covariance(3, 3) = std::pow(plane.distance_sigma.value_or(0), 2);
  }
  return covariance;
}

/// Returns the variance of the distance between the points, to first order.
double length_variance(const Inspection& inspection, const std::array<PickedPoint, 2>& points) {
  const Uncertainty& uncertainty = *inspection.initialization->uncertainty;
  Eigen::Matrix<double, kErrors, kErrors> covariance =
      Eigen::Matrix<double, kErrors, kErrors>::Zero();
  for (int k = 0; k < 2; ++k)
    covariance.block<4, 4>(4 * k, 4 * k) = plane_covariance(inspection, points[k].number);
  const auto frame = static_cast<std::size_t>(points[0].frame);
  if (frame < uncertainty.center_covariances.size())
    covariance.block<3, 3>(8, 8) = uncertainty.center_covariances[frame];
  covariance.diagonal().tail<4>().setConstant(kPickedSigma_px * kPickedSigma_px);
  Errors gradient;
  for (int i = 0; i < kErrors; ++i) {
    const double step = i < 11 ? 1e-6 : 1e-3;  // pixels
    const Errors errors = step * Errors::Unit(i);
    gradient[i] =
        (length_with(inspection, points, errors) - length_with(inspection, points, -errors)) /
        (2 * step);
  }
  return gradient.dot(covariance * gradient);
}

MeasuredScale scale_of(const Inspection& inspection) {
  const Settings& settings = inspection.settings;
  if (settings.scale_points.empty()) throw InputError("scale_length needs scale_points");
  if (!settings.scale_length) throw InputError("scale_points need scale_length");
  const auto points = picked_points(inspection, settings.scale_points);
  const double length = length_with(inspection, points, Errors::Zero());
  if (!(length > 1e-9)) throw InputError("the points are at the same place");
  MeasuredScale scale{*settings.scale_length / length};
  if (!inspection.initialization->uncertainty) return scale;
  scale.log_sigma = std::hypot(settings.scale_length_sigma / *settings.scale_length,
                               std::sqrt(length_variance(inspection, points)) / length);
  return scale;
}

Vector3d z_axis(const Inspection& inspection, const Plane& plane) {
  // Planes face the reference camera.
  if (inspection.settings.world_up == WorldUp::plane) return plane.normal;
  const auto& inertial = inspection.inertial;
  if (!inertial || !inertial->ok)
    throw InputError(fmt::format("gravity is unknown ({})",
                                 inertial ? inertial->reason : "no accelerometer is used"));
  return -inertial->gravity_m_s2.normalized();
}

Pose axes_of(const Inspection& inspection) {
  const auto points = picked_points(inspection, inspection.settings.world_points);
  const Vector3d origin = *position(inspection, points[0]);
  const Vector3d z = z_axis(inspection, points[0].plane);
  const Vector3d towards = *position(inspection, points[1]) - origin;
  const Vector3d x = towards - z * z.dot(towards);
  if (!(x.norm() > 1e-6 * towards.norm()))
    throw InputError("the second point is above the origin and determines no x axis");
  Pose T_reference_world;
  T_reference_world.R_wc << x.normalized(), z.cross(x.normalized()), z;
  T_reference_world.p_wc = origin;
  return inverse(T_reference_world);
}

/// Returns what `compute` returns, or a value with the reason why it throws.
template <class Value, class Compute>
Value with_reason(const char* key, const Compute& compute) {
  try {
    return compute();
  } catch (const InputError& error) {
    Value unknown;
    unknown.reason = fmt::format("{}: {}", key, error.what());
    return unknown;
  }
}

}  // namespace

std::optional<MeasuredScale> measure_scale(const Inspection& inspection) {
  const Settings& settings = inspection.settings;
  if (settings.scale_points.empty() && !settings.scale_length) return std::nullopt;
  return with_reason<MeasuredScale>("scale_points", [&] { return scale_of(inspection); });
}

std::optional<ChosenWorld> choose_world(const Inspection& inspection) {
  if (inspection.settings.world_points.empty()) return std::nullopt;
  return with_reason<ChosenWorld>("world_points", [&] { return ChosenWorld{axes_of(inspection)}; });
}

ExportWorld export_world(const Inspection& inspection, bool metric) {
  check_chosen(inspection);
  ExportWorld world;
  world.meters = metric || inspection.measured_scale;
  Similarity& T = world.T_world_reference;
  if (world.meters) T.scale = meters_per_unit(inspection);
  if (!inspection.chosen_world) return world;
  const Pose& chosen = inspection.chosen_world->T_world_reference;
  T.R_ab = chosen.R_wc;
  T.t_ab = T.scale * chosen.p_wc;
  world.axes =
      fmt::format("world = chosen (z {}, x towards a second point)",
                  inspection.settings.world_up == WorldUp::plane ? "normal to the plane" : "up");
  return world;
}

void check_chosen(const Inspection& inspection) {
  if (inspection.measured_scale && !inspection.measured_scale->reason.empty())
    throw InputError(inspection.measured_scale->reason);
  if (inspection.chosen_world && !inspection.chosen_world->reason.empty())
    throw InputError(inspection.chosen_world->reason);
}

}  // namespace gpo
