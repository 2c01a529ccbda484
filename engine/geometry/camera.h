// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace gpo {

enum class Distortion { none, radial_tangential, equidistant };

/// Readout of rows, or columns, as an image is shown; a clockwise quarter turn makes each the next.
enum class ReadoutDirection { down, left, up, right };

template <>
struct ChoiceKeys<ReadoutDirection> {
  static constexpr const char* name = "readout direction";
  static constexpr std::array keys{"down", "left", "up", "right"};
};

/// Time from the first row to the last in the direction of the readout, negative in reverse.
struct Readout {
  double seconds = 0;
  double sigma_s = 0;  ///< above zero; `readout_of` sets a usual one

  bool operator==(const Readout&) const = default;
};

/// Axes: x right, y down, z forward. The center of the top-left pixel is (0, 0). "Raw" pixels are
/// those of the recorded image, "undistorted" ones of the pinhole camera with the same intrinsics.
struct Camera {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fx = 0;   ///< [px]
  double fy = 0;   ///< [px]
  double cx = 0;   ///< [px]
  double cy = 0;   ///< [px]
  Distortion distortion = Distortion::none;
  /// radial_tangential: k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]], in OpenCV's order;
  /// equidistant: k1 k2 k3 k4 (Kannala-Brandt). Missing ones are zero.
  std::vector<double> coefficients = {};
  /// Standard deviations of fx, fy, cx, cy [px] and the coefficients; empty: unknown, zeros: exact.
  std::vector<double> sigmas = {};
  /// Upper triangle of their covariance, row by row, instead of `sigmas`; empty: independent.
  std::vector<double> covariance = {};
  std::optional<Readout> readout = std::nullopt;                     ///< nullopt: unknown
  std::optional<ReadoutDirection> readout_direction = std::nullopt;  ///< nullopt: down

  bool operator==(const Camera&) const = default;
};

inline constexpr double kUsualView_deg = 70;

/// Pinhole camera with centered principal point; the focal length is a multiple of the diagonal.
Camera camera_of_focal(int width, int height, double focal_diagonals);
Camera camera_of_view(int width, int height, double diagonal_deg = kUsualView_deg);

inline constexpr double kLargestCoefficient = 1e6;
bool is_focal_length(double focal_px);
bool are_coefficients(const std::vector<double>& coefficients);
/// True if the principal point is within one image size of the image, or the size is unknown.
bool has_near_principal_point(const Camera& camera);
inline constexpr double kLeastReadoutSigma_s = 1e-4;
/// With a standard deviation of 2 %, at least `kLeastReadoutSigma_s`.
Readout readout_of(double seconds);
Eigen::Vector2d readout_direction(const Camera& camera);
int readout_lines(const Camera& camera);

/// Returns true for a symmetric, positive semidefinite matrix, up to the rounding in files.
bool is_covariance(const Eigen::MatrixXd& matrix);
void set_lens_covariance(Camera& camera, const Eigen::MatrixXd& covariance);
Eigen::MatrixXd from_upper_triangle(const std::vector<double>& values);
/// F F^T = covariance; no columns if it is unknown, one zero column if the camera is exact.
Eigen::MatrixXd lens_root(const Camera& camera);

/// Throws InputError for implausible numbers and an uncertainty of other parameters.
void check_camera(const Camera& camera);

Eigen::Matrix3d intrinsic_matrix(const Camera& camera);

/// Unit of thresholds on pixels: 1 from 512x512 to 1280x960, proportional beyond.
double pixel_unit(const Camera& camera);
double pixel_unit(const Eigen::Matrix3d& K);

/// Returns the raw pixel of a point in the camera frame (z > 0); NaN beyond the valid radius.
Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c);

/// Returns the raw pixel of an undistorted one; NaN beyond the valid radius.
Eigen::Vector2d distort(const Camera& camera, const Eigen::Vector2d& undistorted_px);

/// Newton's method to 1e-10 px. NaN if there is no inverse within the valid radius.
Eigen::Vector2d undistort(const Camera& camera, const Eigen::Vector2d& raw_px);

/// Moves of an undistorted pixel by `errors` (parameters x n), its raw pixel and K fixed; 2 x n.
Eigen::Matrix2Xd undistortion_moves_px(const Camera& camera,
                                       const Eigen::MatrixXd& errors,
                                       const Eigen::Vector2d& undistorted_px);

}  // namespace gpo
