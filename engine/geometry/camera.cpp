// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/geometry/camera.h"

#include "engine/base/error.h"
#include "engine/base/limits.h"
#include "engine/geometry/decompositions.h"
#include "engine/geometry/pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

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

double coefficient(const Camera& camera, std::size_t i) {
  return i < camera.coefficients.size() ? camera.coefficients[i] : 0.0;
}

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
Vector2d radial_tangential(const Camera& c, const Vector2d& x) {
  const double r2 = x.squaredNorm();
  const double radial =
      (1 + r2 * (coefficient(c, 0) + r2 * (coefficient(c, 1) + r2 * coefficient(c, 4)))) /
      (1 + r2 * (coefficient(c, 5) + r2 * (coefficient(c, 6) + r2 * coefficient(c, 7))));
  const double p1 = coefficient(c, 2), p2 = coefficient(c, 3);
  const double xy = x.x() * x.y();
  Vector2d distorted = radial * x + Vector2d(2 * p1 * xy + p2 * (r2 + 2 * x.x() * x.x()),
                                             p1 * (r2 + 2 * x.y() * x.y()) + 2 * p2 * xy);
  if (c.coefficients.size() <= 8) return distorted;
  distorted += r2 * Vector2d(coefficient(c, 8) + r2 * coefficient(c, 9),
                             coefficient(c, 10) + r2 * coefficient(c, 11));
  if (c.coefficients.size() <= 12) return distorted;
  return tilted(coefficient(c, 12), coefficient(c, 13), distorted);
}

/// True if the radial part r N(r^2) / D(r^2) of Brown's model increases at s = r^2 without a pole.
bool rises(const Camera& c, double s) {
  const double k1 = coefficient(c, 0), k2 = coefficient(c, 1), k3 = coefficient(c, 4);
  const double k4 = coefficient(c, 5), k5 = coefficient(c, 6), k6 = coefficient(c, 7);
  const double N = 1 + s * (k1 + s * (k2 + s * k3));
  const double D = 1 + s * (k4 + s * (k5 + s * k6));
  const double dN = k1 + s * (2 * k2 + s * 3 * k3);
  const double dD = k4 + s * (2 * k5 + s * 3 * k6);
  return D > 0 && (N + 2 * s * dN) * D - 2 * s * N * dD > 0;
}

/// Sufficient condition for no fold up to r^2 = s: the negative terms sum up to less than 1.
bool plainly_rises(const Camera& c, double s) {
  if (c.coefficients.size() > 5) return false;
  const auto falling = [](double k) { return std::max(0.0, -k); };
  return s * (3 * falling(coefficient(c, 0)) +
              s * (5 * falling(coefficient(c, 1)) + s * 7 * falling(coefficient(c, 4)))) <
         1;
}

bool within_valid_radius(const Camera& camera, const Vector2d& ideal) {
  const double s = ideal.squaredNorm();
  if (!std::isfinite(s)) return false;
  if (plainly_rises(camera, s)) return true;
  for (int i = 1; i <= kSamples; ++i) {
    const double part = static_cast<double>(i) / kSamples;
    if (!rises(camera, s * part * part)) return false;
  }
  return true;
}

/// Kannala-Brandt: the distorted angle from the optical axis.
double distorted_angle(const Camera& c, double theta) {
  const double t2 = theta * theta;
  return theta *
         (1 + t2 * (coefficient(c, 0) +
                    t2 * (coefficient(c, 1) + t2 * (coefficient(c, 2) + t2 * coefficient(c, 3)))));
}

double slope_of_angle(const Camera& c, double theta) {
  const double t2 = theta * theta;
  return 1 + t2 * (3 * coefficient(c, 0) +
                   t2 * (5 * coefficient(c, 1) +
                         t2 * (7 * coefficient(c, 2) + t2 * 9 * coefficient(c, 3))));
}

bool angle_is_valid(const Camera& camera, double theta) {
  for (int i = 1; i <= kSamples; ++i) {
    if (!(slope_of_angle(camera, theta * i / kSamples) > 0)) return false;
  }
  return true;
}

Vector2d equidistant(const Camera& camera, const Vector2d& x) {
  const double r = x.norm();
  if (r < 1e-12) return x;
  const double theta = std::atan(r);
  if (!angle_is_valid(camera, theta)) return kNowhere;
  return x * (distorted_angle(camera, theta) / r);
}

Vector2d invert_radial_tangential(const Camera& camera,
                                  const Vector2d& distorted,
                                  double tolerance) {
  Vector2d x = distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vector2d error = radial_tangential(camera, x) - distorted;
    if (error.norm() < tolerance) return within_valid_radius(camera, x) ? x : kNowhere;
    Matrix2d J;
    for (int k = 0; k < 2; ++k) {
      const Vector2d h = kDifference * Vector2d::Unit(k);
      J.col(k) =
          (radial_tangential(camera, x + h) - radial_tangential(camera, x - h)) / (2 * kDifference);
    }
    if (!(J.determinant() > 0)) return kNowhere;
    x -= J.inverse() * error;
  }
  return kNowhere;
}

Vector2d invert_equidistant(const Camera& camera, const Vector2d& distorted, double tolerance) {
  const double r_distorted = distorted.norm();
  if (r_distorted < 1e-12) return distorted;
  double theta = r_distorted;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double error = distorted_angle(camera, theta) - r_distorted;
    if (std::abs(error) < tolerance) {
      const bool seen = theta < std::numbers::pi / 2 && angle_is_valid(camera, theta);
      return seen ? Vector2d(distorted * (std::tan(theta) / r_distorted)) : kNowhere;
    }
    const double slope = slope_of_angle(camera, theta);
    if (!(slope > 0)) return kNowhere;
    theta -= error / slope;
  }
  return kNowhere;
}

Vector2d to_pixel(const Camera& camera, const Vector2d& x) {
  return {camera.fx * x.x() + camera.cx, camera.fy * x.y() + camera.cy};
}

Vector2d from_pixel(const Camera& camera, const Vector2d& px) {
  return {(px.x() - camera.cx) / camera.fx, (px.y() - camera.cy) / camera.fy};
}

double& parameter(Camera& camera, std::size_t k) {
  double* const pinhole[] = {&camera.fx, &camera.fy, &camera.cx, &camera.cy};
  return k < 4 ? *pinhole[k] : camera.coefficients[k - 4];
}

Eigen::MatrixXd correlations_of(const Eigen::MatrixXd& covariance) {
  const Eigen::VectorXd inverse = covariance.diagonal().unaryExpr(
      [](double variance) { return variance > 0 ? 1 / std::sqrt(variance) : 0; });
  return inverse.asDiagonal() * covariance * inverse.asDiagonal();
}

void check_uncertainty(const Camera& camera) {
  const std::size_t all = 4 + camera.coefficients.size();
  const auto& sigmas = camera.sigmas;
  const auto& covariance = camera.covariance;
  if (!covariance.empty() &&
      (covariance.size() != all * (all + 1) / 2 || !is_covariance(from_upper_triangle(covariance))))
    throw InputError(
        fmt::format("camera: a covariance of {} numbers, expected the upper triangle of a positive "
                    "semidefinite {}x{} matrix",
                    covariance.size(),
                    all,
                    all));
  if (!sigmas.empty() && sigmas.size() != 4 && sigmas.size() != all)
    throw InputError(
        fmt::format("camera: {} standard deviations, expected none, 4 or {}", sigmas.size(), all));
}

/// Returns (x / z, y / z) distorted. NaN beyond the valid radius, where the polynomial folds back.
Vector2d distort_normalized(const Camera& camera, const Vector2d& ideal) {
  if (camera.distortion == Distortion::none) return ideal;
  if (camera.distortion == Distortion::equidistant) return equidistant(camera, ideal);
  return within_valid_radius(camera, ideal) ? radial_tangential(camera, ideal) : kNowhere;
}

double unit_of_diagonal(double px) {
  constexpr double kLeast_px = 720, kMost_px = 1600;
  return std::min(1.0, px / kLeast_px) * std::max(1.0, px / kMost_px);
}

}  // namespace

bool is_focal_length(double focal_px) { return focal_px > 0 && focal_px <= 1e6; }

bool are_coefficients(const std::vector<double>& coefficients) {
  return std::ranges::all_of(coefficients,
                             [](double k) { return std::abs(k) <= kLargestCoefficient; });
}

bool has_near_principal_point(const Camera& camera) {
  if (camera.width == 0 || camera.height == 0) return true;
  return camera.cx > -camera.width && camera.cx < 2 * camera.width && camera.cy > -camera.height &&
         camera.cy < 2 * camera.height;
}

bool is_covariance(const Eigen::MatrixXd& matrix) {
  constexpr double kRounding = 1e-6;  // error of a correlation in a file
  if (!matrix.allFinite() || matrix != matrix.transpose()) return false;
  for (Eigen::Index k = 0; k < matrix.rows(); ++k)
    if (!(matrix(k, k) > 0) && !matrix.col(k).isZero(0)) return false;
  return matrix.rows() == 0 ||
         symmetric_eigen(correlations_of(matrix)).values.minCoeff() > -kRounding;
}

Eigen::MatrixXd from_upper_triangle(const std::vector<double>& values) {
  const auto size = static_cast<Eigen::Index>(std::sqrt(2.0 * static_cast<double>(values.size())));
  if (size * (size + 1) / 2 != std::ssize(values))
    throw InputError(fmt::format("a covariance of {} numbers is no triangle", values.size()));
  Eigen::MatrixXd matrix(size, size);
  std::size_t next = 0;
  for (Eigen::Index row = 0; row < size; ++row)
    for (Eigen::Index column = row; column < size; ++column)
      matrix(row, column) = matrix(column, row) = values[next++];
  return matrix;
}

void set_lens_covariance(Camera& camera, const Eigen::MatrixXd& covariance) {
  camera.sigmas.clear();
  camera.covariance.clear();
  for (Eigen::Index row = 0; row < covariance.rows(); ++row) {
    camera.sigmas.push_back(std::sqrt(covariance(row, row)));
    for (Eigen::Index column = row; column < covariance.cols(); ++column)
      camera.covariance.push_back(covariance(row, column));
  }
}

Eigen::MatrixXd lens_root(const Camera& camera) {
  const auto& sigmas = camera.sigmas;
  Eigen::MatrixXd root = Eigen::VectorXd::Map(sigmas.data(), std::ssize(sigmas)).asDiagonal();
  if (!camera.covariance.empty()) {
    const Eigen::MatrixXd covariance = from_upper_triangle(camera.covariance);
    const auto [values, vectors] = symmetric_eigen(correlations_of(covariance));
    root = covariance.diagonal().cwiseSqrt().asDiagonal() * vectors *
           values.cwiseMax(0).cwiseSqrt().asDiagonal();
  }
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < root.cols(); ++k)
    if (!root.col(k).isZero(0)) columns.push_back(k);
  if (columns.empty() && root.cols() > 0) columns.push_back(0);
  return root(Eigen::all, columns);
}

void check_camera(const Camera& camera) {
  const auto positive = [](double focal) { return std::isfinite(focal) && focal > 0; };
  if (!positive(camera.fx) || !positive(camera.fy) || !std::isfinite(camera.cx + camera.cy))
    throw InputError(
        fmt::format("camera: fx {}, fy {}, cx {}, cy {}, expected focal lengths above 0",
                    camera.fx,
                    camera.fy,
                    camera.cx,
                    camera.cy));
  const std::size_t most = camera.distortion == Distortion::equidistant ? 4 : 14;
  if (camera.coefficients.size() > most)
    throw InputError(fmt::format("camera: {} distortion coefficients, expected at most {}",
                                 camera.coefficients.size(),
                                 most));
  check_uncertainty(camera);
  constexpr AcceptedRange kSize{0, 1e6, "0 to 1e6"}, kFocal{1e-3, 1e6, "0.001 to 1e6"};
  constexpr AcceptedRange kCoefficient{-kLargestCoefficient, kLargestCoefficient, "at most 1e6"};
  constexpr AcceptedRange kSigma{0, kLargestCoefficient, "0 to 1e6"};
  constexpr AcceptedRange kCovariance{-1e12, 1e12, "at most 1e12"};
  constexpr AcceptedRange kPart{-0.999, 0.999, "less than a second"};
  std::vector<Limit> limits{{"width", static_cast<double>(camera.width), kSize},
                            {"height", static_cast<double>(camera.height), kSize},
                            {"fx", camera.fx, kFocal},
                            {"fy", camera.fy, kFocal},
                            {"cx", camera.cx, kFinite},
                            {"cy", camera.cy, kFinite}};
  for (const double k : camera.coefficients)
    limits.push_back({"distortion coefficient", k, kCoefficient});
  for (const double sigma : camera.sigmas) limits.push_back({"standard deviation", sigma, kSigma});
  for (const double entry : camera.covariance) limits.push_back({"covariance", entry, kCovariance});
  if (camera.readout) {
    limits.push_back({"readout seconds", camera.readout->seconds, kPart});
    limits.push_back({"readout sigma_s", camera.readout->sigma_s, kAboveZero});
  }
  check_limits("camera", limits);
}

Readout readout_of(double seconds) {
  return {seconds, std::max(kLeastReadoutSigma_s, 0.02 * std::abs(seconds))};
}

Vector2d readout_direction(const Camera& camera) {
  constexpr std::array<std::array<double, 2>, 4> kDirections{{{0, 1}, {-1, 0}, {0, -1}, {1, 0}}};
  const auto& [x, y] = kDirections[static_cast<std::size_t>(
      camera.readout_direction.value_or(ReadoutDirection::down))];
  return {x, y};
}

int readout_lines(const Camera& camera) {
  return readout_direction(camera).x() != 0 ? camera.width : camera.height;
}

Eigen::Matrix3d intrinsic_matrix(const Camera& camera) {
  return Eigen::Matrix3d{{camera.fx, 0, camera.cx}, {0, camera.fy, camera.cy}, {0, 0, 1}};
}

double pixel_unit(const Camera& camera) {
  if (camera.width == 0 || camera.height == 0) return pixel_unit(intrinsic_matrix(camera));
  return unit_of_diagonal(std::hypot(camera.width, camera.height));
}

double pixel_unit(const Eigen::Matrix3d& K) {
  return unit_of_diagonal(std::hypot(2 * K(0, 2) + 1, 2 * K(1, 2) + 1));
}

Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c) {
  return to_pixel(camera, distort_normalized(camera, point_c.hnormalized()));
}

Vector2d distort(const Camera& camera, const Vector2d& undistorted_px) {
  return to_pixel(camera, distort_normalized(camera, from_pixel(camera, undistorted_px)));
}

Vector2d undistort(const Camera& camera, const Vector2d& raw_px) {
  if (camera.distortion == Distortion::none) return raw_px;
  const auto invert =
      camera.distortion == Distortion::equidistant ? invert_equidistant : invert_radial_tangential;
  const double tolerance = 1e-10 / std::max(camera.fx, camera.fy);
  return to_pixel(camera, invert(camera, from_pixel(camera, raw_px), tolerance));
}

Eigen::Matrix2Xd undistortion_moves_px(const Camera& camera,
                                       const Eigen::MatrixXd& errors,
                                       const Vector2d& undistorted_px) {
  constexpr double kStep = 1e-5;  // in normalized coordinates, and of each error
  const auto parameters = 4 + std::ssize(camera.coefficients);
  if (errors.rows() > parameters)
    throw InputError(fmt::format(
        "camera: lens errors of {} parameters, expected at most {}", errors.rows(), parameters));
  const Vector2d x = from_pixel(camera, undistorted_px);
  const auto raw = [](const Camera& by, const Vector2d& at) {
    return to_pixel(by, distort_normalized(by, at));
  };
  // The raw pixel is fixed: 0 = d raw / d parameter + (d raw / d x) dx.
  Eigen::Matrix2d slope;
  for (int k = 0; k < 2; ++k) {
    const Vector2d step = kStep * Vector2d::Unit(k);
    slope.col(k) = (raw(camera, x + step) - raw(camera, x - step)) / (2 * kStep);
  }
  const Eigen::Matrix2d inverse = slope.inverse();
  Camera given = camera, other = camera;
  const auto raw_with = [&](double factor, const auto& error) {
    for (Eigen::Index k = 0; k < error.size(); ++k)
      parameter(other, k) = parameter(given, k) + factor * error(k);
    return raw(other, x);
  };
  Eigen::Matrix2Xd moves(2, errors.cols());
  for (Eigen::Index c = 0; c < errors.cols(); ++c) {
    const Vector2d change = raw_with(kStep, errors.col(c)) - raw_with(-kStep, errors.col(c));
    const Vector2d dx = -(inverse * change) / (2 * kStep);
    moves.col(c) = dx.cwiseProduct(Vector2d(camera.fx, camera.fy));
  }
  return moves;
}

Camera camera_of_focal(int width, int height, double focal_diagonals) {
  const double focal_px = focal_diagonals * std::hypot(width, height);
  return {.width = width,
          .height = height,
          .fx = focal_px,
          .fy = focal_px,
          .cx = 0.5 * (width - 1),
          .cy = 0.5 * (height - 1)};
}

Camera camera_of_view(int width, int height, double diagonal_deg) {
  return camera_of_focal(width, height, 0.5 / std::tan(radians(diagonal_deg) / 2));
}

}  // namespace gpo
