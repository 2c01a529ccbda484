// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"
#include "engine/geometry/lens_models.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kNewtonSteps = 30;
constexpr int kSamples = 64;          // along the radius, to find where the polynomial folds back
constexpr double kDifference = 1e-6;  // step of central differences, in normalized coordinates
const Vector2d kNowhere(kNaN, kNaN);

Coefficients without_first(Coefficients k) { return k.subspan(std::min<std::size_t>(1, k.size())); }

double coefficient(Coefficients k, std::size_t i) { return i < k.size() ? k[i] : 0.0; }

/// Projects onto a sensor tilted by tau_x and tau_y [rad] (OpenCV's CALIB_TILTED_MODEL).
Vector2d tilted(double tau_x, double tau_y, const Vector2d& x) {
  Eigen::Matrix3d R_x, R_y;
  R_x << 1, 0, 0, 0, std::cos(tau_x), std::sin(tau_x), 0, -std::sin(tau_x), std::cos(tau_x);
  R_y << std::cos(tau_y), 0, -std::sin(tau_y), 0, 1, 0, std::sin(tau_y), 0, std::cos(tau_y);
  const Eigen::Matrix3d R = R_y * R_x;
  Eigen::Matrix3d onto_sensor;
  onto_sensor << R(2, 2), 0, -R(0, 2), 0, R(2, 2), -R(1, 2), 0, 0, 1;
  return (onto_sensor * R * x.homogeneous()).hnormalized();
}

/// Brown's model: k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y.
Vector2d brown(Coefficients k, const Vector2d& x) {
  const double r2 = x.squaredNorm();
  const double radial =
      (1 + r2 * (coefficient(k, 0) + r2 * (coefficient(k, 1) + r2 * coefficient(k, 4)))) /
      (1 + r2 * (coefficient(k, 5) + r2 * (coefficient(k, 6) + r2 * coefficient(k, 7))));
  const double p1 = coefficient(k, 2), p2 = coefficient(k, 3);
  const double xy = x.x() * x.y();
  Vector2d distorted = radial * x + Vector2d(2 * p1 * xy + p2 * (r2 + 2 * x.x() * x.x()),
                                             p1 * (r2 + 2 * x.y() * x.y()) + 2 * p2 * xy);
  if (k.size() <= 8) return distorted;
  distorted += r2 * Vector2d(coefficient(k, 8) + r2 * coefficient(k, 9),
                             coefficient(k, 10) + r2 * coefficient(k, 11));
  if (k.size() <= 12) return distorted;
  return tilted(coefficient(k, 12), coefficient(k, 13), distorted);
}

/// True if the radial part r N(r^2) / D(r^2) of Brown's model increases at s = r^2 without a pole.
bool rises(Coefficients k, double s) {
  const double k1 = coefficient(k, 0), k2 = coefficient(k, 1), k3 = coefficient(k, 4);
  const double k4 = coefficient(k, 5), k5 = coefficient(k, 6), k6 = coefficient(k, 7);
  const double N = 1 + s * (k1 + s * (k2 + s * k3));
  const double D = 1 + s * (k4 + s * (k5 + s * k6));
  const double dN = k1 + s * (2 * k2 + s * 3 * k3);
  const double dD = k4 + s * (2 * k5 + s * 3 * k6);
  return D > 0 && (N + 2 * s * dN) * D - 2 * s * N * dD > 0;
}

/// Sufficient condition for no fold up to r^2 = s: the negative terms sum up to less than 1.
bool plainly_rises(Coefficients k, double s) {
  if (k.size() > 5) return false;
  const auto falling = [](double value) { return std::max(0.0, -value); };
  return s * (3 * falling(coefficient(k, 0)) +
              s * (5 * falling(coefficient(k, 1)) + s * 7 * falling(coefficient(k, 4)))) <
         1;
}

bool within_valid_radius(Coefficients k, const Vector2d& ideal) {
  const double s = ideal.squaredNorm();
  if (!std::isfinite(s)) return false;
  if (plainly_rises(k, s)) return true;
  for (int i = 1; i <= kSamples; ++i) {
    const double part = static_cast<double>(i) / kSamples;
    if (!rises(k, s * part * part)) return false;
  }
  return true;
}

Vector2d radial_tangential(Coefficients k, const Vector2d& x) {
  return within_valid_radius(k, x) ? brown(k, x) : kNowhere;
}

using RadialTerms = std::array<double, 4>;

RadialTerms radial_terms(Coefficients k) {
  return {coefficient(k, 0), coefficient(k, 1), coefficient(k, 2), coefficient(k, 3)};
}

/// Kannala-Brandt: the distorted angle from the optical axis.
double distorted_angle(const RadialTerms& k, double theta) {
  const double t2 = theta * theta;
  return theta * (1 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3]))));
}

double slope_of_angle(const RadialTerms& k, double theta) {
  const double t2 = theta * theta;
  return 1 + t2 * (3 * k[0] + t2 * (5 * k[1] + t2 * (7 * k[2] + t2 * 9 * k[3])));
}

bool angle_is_valid(const RadialTerms& k, double theta) {
  for (int i = 1; i <= kSamples; ++i) {
    if (!(slope_of_angle(k, theta * i / kSamples) > 0)) return false;
  }
  return true;
}

Vector2d equidistant(Coefficients k, const Vector2d& x) {
  const double r = x.norm();
  if (r < 1e-12) return x;
  const double theta = std::atan(r);
  const RadialTerms terms = radial_terms(k);
  return angle_is_valid(terms, theta) ? Vector2d(x * (distorted_angle(terms, theta) / r))
                                      : kNowhere;
}

/// Inverts `distort` by Newton's method; NaN if that fails.
template <typename Distort>
Vector2d solve(const Distort& distort, const Vector2d& distorted, double tolerance) {
  Vector2d x = distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector2d error = distort(x) - distorted;
    if (error.norm() < tolerance) return x;
    Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      const Vector2d h = kDifference * Vector2d::Unit(k);
      J.col(k) = (distort(x + h) - distort(x - h)) / (2 * kDifference);
    }
    if (!(J.determinant() > 0)) return kNowhere;
    x -= J.inverse() * error;
  }
  return kNowhere;
}

Vector2d invert_radial_tangential(Coefficients k, const Vector2d& distorted, double tolerance) {
  const Vector2d x = solve([&](const Vector2d& at) { return brown(k, at); }, distorted, tolerance);
  return within_valid_radius(k, x) ? x : kNowhere;
}

Vector2d invert_equidistant(Coefficients k, const Vector2d& distorted, double tolerance) {
  const double r_distorted = distorted.norm();
  if (r_distorted < 1e-12) return distorted;
  const RadialTerms terms = radial_terms(k);
  double theta = r_distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double error = distorted_angle(terms, theta) - r_distorted;
    if (std::abs(error) < tolerance) {
      const bool seen = theta < std::numbers::pi / 2 && angle_is_valid(terms, theta);
      return seen ? Vector2d(distorted * (std::tan(theta) / r_distorted)) : kNowhere;
    }
    const double slope = slope_of_angle(terms, theta);
    if (!(slope > 0)) return kNowhere;
    theta -= error / slope;
  }
  return kNowhere;
}

/// Returns (x / z, y / z) of a ray; NaN unless it points forward.
Vector2d in_front(const Vector2d& xy, double z) { return z > 0 ? Vector2d(xy / z) : kNowhere; }

/// Usenko et al., "The Double Sphere Camera Model" (3DV 2018), equations (40) to (45): xi, alpha.
Vector2d double_sphere(Coefficients k, const Vector2d& x) {
  const double xi = coefficient(k, 0), alpha = coefficient(k, 1);
  const double d1 = std::sqrt(1 + x.squaredNorm());
  const double shifted = 1 + xi * d1;
  const double w1 = alpha > 0.5 ? (1 - alpha) / alpha : alpha / (1 - alpha);
  const double w2 = (w1 + xi) / std::sqrt(2 * w1 * xi + xi * xi + 1);
  const double divisor =
      alpha * std::sqrt(x.squaredNorm() + shifted * shifted) + (1 - alpha) * shifted;
  return 1 > -w2 * d1 && divisor > 0 ? Vector2d(x * (1 + xi) / divisor) : kNowhere;
}

/// Equations (46) to (50) there.
Vector2d invert_double_sphere(Coefficients k, const Vector2d& distorted, double /*tolerance*/) {
  const double xi = coefficient(k, 0), alpha = coefficient(k, 1);
  const Vector2d m = distorted / (1 + xi);
  const double r2 = m.squaredNorm();
  const double root = std::sqrt(1 - (2 * alpha - 1) * r2);  // NaN outside of the image
  const double m_z = (1 - alpha * alpha * r2) / (alpha * root + 1 - alpha);
  const double scale = (m_z * xi + std::sqrt(m_z * m_z + (1 - xi * xi) * r2)) / (m_z * m_z + r2);
  return in_front(scale * m, scale * m_z - xi);
}

/// Khomutenko et al., "An Enhanced Unified Camera Model" (RA-L 2016): alpha, beta.
Vector2d extended_unified(Coefficients k, const Vector2d& x) {
  const double alpha = coefficient(k, 0), beta = coefficient(k, 1);
  return x / (alpha * std::sqrt(beta * x.squaredNorm() + 1) + 1 - alpha);
}

Vector2d invert_extended_unified(Coefficients k, const Vector2d& m, double /*tolerance*/) {
  const double alpha = coefficient(k, 0), beta = coefficient(k, 1);
  const double r2 = m.squaredNorm();
  const double root = std::sqrt(1 - (2 * alpha - 1) * beta * r2);  // NaN outside of the image
  return in_front(m, (1 - beta * alpha * alpha * r2) / (alpha * root + 1 - alpha));
}

/// Mei and Rives, "Single View Point Omnidirectional Camera Calibration from Planar Grids" (ICRA
/// 2007): xi, k1, k2, p1, p2.
Vector2d omnidirectional(Coefficients k, const Vector2d& x) {
  const double xi = coefficient(k, 0);
  const Vector2d on_plane = x / (1 + xi * std::sqrt(1 + x.squaredNorm()));
  return (1 + xi) * radial_tangential(without_first(k), on_plane);
}

Vector2d invert_omnidirectional(Coefficients k, const Vector2d& distorted, double tolerance) {
  const double xi = coefficient(k, 0);
  const Vector2d m =
      invert_radial_tangential(without_first(k), distorted / (1 + xi), tolerance / (1 + xi));
  const double r2 = m.squaredNorm();
  const double scale = (xi + std::sqrt(1 + (1 - xi * xi) * r2)) / (1 + r2);
  return in_front(scale * m, scale - xi);
}

/// Devernay and Faugeras, "Straight lines have to be straight" (2001): w [rad].
Vector2d field_of_view(Coefficients k, const Vector2d& x) {
  const double stretched = 2 * std::tan(coefficient(k, 0) / 2) * x.norm();
  return stretched < 1e-12 ? x : Vector2d(x * (std::atan(stretched) / stretched));
}

Vector2d invert_field_of_view(Coefficients k, const Vector2d& distorted, double /*tolerance*/) {
  const double angle = 2 * std::tan(coefficient(k, 0) / 2) * distorted.norm();
  if (angle < 1e-12) return distorted;
  return angle < std::numbers::pi / 2 ? Vector2d(distorted * (std::tan(angle) / angle)) : kNowhere;
}

/// k1 k2 p1 p2 k3 k4 s1 s2: equidistant, then Brown's terms up to r^8 and a thin prism.
RadialTerms prism_terms(Coefficients k) {
  return {coefficient(k, 0), coefficient(k, 1), coefficient(k, 4), coefficient(k, 5)};
}

Vector2d prism(Coefficients k, const Vector2d& x) {
  const double r2 = x.squaredNorm(), xy = x.x() * x.y();
  const double p1 = coefficient(k, 2), p2 = coefficient(k, 3);
  const double r = std::sqrt(r2);
  const double radial = r > 0 ? distorted_angle(prism_terms(k), r) / r : 1;
  return radial * x +
         Vector2d(2 * p1 * xy + p2 * (r2 + 2 * x.x() * x.x()) + coefficient(k, 6) * r2,
                  p1 * (r2 + 2 * x.y() * x.y()) + 2 * p2 * xy + coefficient(k, 7) * r2);
}

Vector2d thin_prism_fisheye(Coefficients k, const Vector2d& x) {
  const double r = x.norm();
  if (r < 1e-12) return x;
  const double theta = std::atan(r);
  return angle_is_valid(prism_terms(k), theta) ? prism(k, x * (theta / r)) : kNowhere;
}

Vector2d invert_thin_prism_fisheye(Coefficients k, const Vector2d& distorted, double tolerance) {
  const Vector2d angles =
      solve([&](const Vector2d& at) { return prism(k, at); }, distorted, tolerance);
  const double theta = angles.norm();
  if (theta < 1e-12) return angles;
  return theta < std::numbers::pi / 2 && angle_is_valid(prism_terms(k), theta)
             ? Vector2d(angles * (std::tan(theta) / theta))
             : kNowhere;
}

Vector2d pinhole(Coefficients /*k*/, const Vector2d& x) { return x; }
Vector2d invert_pinhole(Coefficients /*k*/, const Vector2d& x, double /*tolerance*/) { return x; }

/// Range of a coefficient in which a model is defined.
struct CoefficientRange {
  Distortion distortion;
  std::size_t place;
  const char* name;
  double low, high;
};

constexpr double kMostXi = 100;
constexpr std::array<CoefficientRange, 6> kRanges = {
    {{Distortion::double_sphere, 0, "xi", -0.99, kMostXi},
     {Distortion::double_sphere, 1, "alpha", 0, 1},
     {Distortion::extended_unified, 0, "alpha", 0, 1},
     {Distortion::extended_unified, 1, "beta", 1e-6, 1e6},
     {Distortion::omnidirectional, 0, "xi", 0, kMostXi},
     {Distortion::field_of_view, 0, "w", 0, 3.1}}};

}  // namespace

const std::vector<LensModel>& lens_models() {
  // clang-format off
  static const std::vector<LensModel> kModels = {
      {Distortion::none, "none", "", {0}, pinhole, invert_pinhole},
      {Distortion::radial_tangential, "radial-tangential", "k1, k2, p1, p2, k3, ...",
       {4, 5, 8, 12, 14}, radial_tangential, invert_radial_tangential},
      {Distortion::equidistant, "equidistant", "k1, k2, k3, k4", {4},
       equidistant, invert_equidistant},
      {Distortion::double_sphere, "double-sphere", "xi, alpha", {2},
       double_sphere, invert_double_sphere},
      {Distortion::extended_unified, "extended-unified", "alpha, beta", {2},
       extended_unified, invert_extended_unified},
      {Distortion::omnidirectional, "omnidirectional", "xi, k1, k2, p1, p2", {5},
       omnidirectional, invert_omnidirectional},
      {Distortion::field_of_view, "field-of-view", "w", {1}, field_of_view, invert_field_of_view},
      {Distortion::thin_prism_fisheye, "thin-prism-fisheye", "k1, k2, p1, p2, k3, k4, s1, s2", {8},
       thin_prism_fisheye, invert_thin_prism_fisheye}};
  // clang-format on
  return kModels;
}

const LensModel& lens_model(Distortion distortion) {
  return lens_models().at(static_cast<std::size_t>(distortion));
}

std::optional<std::string> coefficient_fault(const Camera& camera) {
  for (const auto& [distortion, place, name, low, high] : kRanges) {
    const double value = coefficient(camera.coefficients, place);
    if (camera.distortion == distortion && !(value >= low && value <= high))
      return fmt::format("{} {:g} outside of {:g} to {:g}", name, value, low, high);
  }
  return std::nullopt;
}

}  // namespace gpo
