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

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

using Eigen::Vector2d;

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

Vector2d distort_normalized(const Camera& camera, const Vector2d& ideal) {
  return lens_model(camera.distortion).distort(camera.coefficients, ideal);
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
  if (!positive(camera.fx) || !positive(camera.fy))
    throw InputError(
        fmt::format("camera: fx {}, fy {}, cx {}, cy {}, expected focal lengths above 0",
                    camera.fx,
                    camera.fy,
                    camera.cx,
                    camera.cy));
  const LensModel& model = lens_model(camera.distortion);
  const bool none = camera.distortion == Distortion::none;
  const std::size_t most = none ? 14 : std::max(model.counts.back(), std::size_t{4});
  if (camera.coefficients.size() > most)
    throw InputError(fmt::format("camera: {} distortion coefficients, expected at most {}",
                                 camera.coefficients.size(),
                                 most));
  if (const auto fault = coefficient_fault(camera))
    throw InputError(fmt::format("camera: found {} in the lens model {}", *fault, model.name));
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

double row_from_middle(const Camera& camera, const Eigen::Vector2d& raw_px) {
  const Eigen::Vector2d middle = 0.5 * Eigen::Vector2d(camera.width - 1, camera.height - 1);
  return readout_direction(camera).dot(raw_px - middle);
}

Eigen::Matrix3d intrinsic_matrix(const Camera& camera) {
  return Eigen::Matrix3d{{camera.fx, 0, camera.cx}, {0, camera.fy, camera.cy}, {0, 0, 1}};
}

double pixel_unit(const Camera& camera) {
  if (camera.width == 0 || camera.height == 0) return pixel_unit(intrinsic_matrix(camera));
  return unit_of_diagonal(std::hypot(camera.width, camera.height));
}

double pixel_unit(const Eigen::Matrix3d& K) {
  constexpr double kUsualDiagonal = 1.25;  // 4:3 image that is as wide as its focal length
  const bool is_inside = K(0, 2) > 0 && K(1, 2) > 0;
  return unit_of_diagonal(is_inside ? std::hypot(2 * K(0, 2) + 1, 2 * K(1, 2) + 1)
                                    : kUsualDiagonal * K(0, 0));
}

Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c) {
  return to_pixel(camera, distort_normalized(camera, point_c.hnormalized()));
}

Vector2d distort(const Camera& camera, const Vector2d& undistorted_px) {
  return to_pixel(camera, distort_normalized(camera, from_pixel(camera, undistorted_px)));
}

Vector2d undistort(const Camera& camera, const Vector2d& raw_px) {
  if (camera.distortion == Distortion::none) return raw_px;
  const double tolerance = 1e-10 / std::max(camera.fx, camera.fy);
  return to_pixel(camera,
                  lens_model(camera.distortion)
                      .undistort(camera.coefficients, from_pixel(camera, raw_px), tolerance));
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
