// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "engine/base/choice.h"
#include "engine/geometry/lens_models.h"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace gpo {

/// Direction in which a rolling shutter reads the rows, or columns, of an image as it is shown. A
/// clockwise quarter turn of the image makes each the next one.
enum class ReadoutDirection { down, left, up, right };

template <>
struct ChoiceKeys<ReadoutDirection>
    : NamedKeys<"readout direction", "down", "left", "up", "right"> {};

/// Time from the first row of an image to the last one in the direction of the readout, negative if
/// the last row is read first.
struct Readout {
  double seconds = 0;
  double sigma_s = 0;  ///< above zero; `readout_of` sets a usual one

  bool operator==(const Readout&) const = default;
};

/// A calibrated camera. Axes: x right, y down, z forward. Pixels: the center of the top-left pixel
/// is (0, 0), as in OpenCV. "Raw" pixels are those of the recorded image, "undistorted" ones those
/// of the ideal pinhole camera with the same intrinsics. In all lens models fx and fy are the focal
/// lengths at the principal point. The authors of the double sphere and the omnidirectional model
/// use (1 + xi) fx, those of the field of view w fx / (2 tan(w / 2)).
struct Camera {
  int width = 0;   ///< [px]
  int height = 0;  ///< [px]
  double fx = 0;   ///< [px]
  double fy = 0;   ///< [px]
  double cx = 0;   ///< [px]
  double cy = 0;   ///< [px]
  Distortion distortion = Distortion::none;
  /// Missing ones are zero. In the order of `lens_models`; radial_tangential: k1 k2 p1 p2 [k3 [k4
  /// k5 k6 [s1 s2 s3 s4 [tau_x tau_y]]]] (rational, thin prism and tilted sensor, as in OpenCV).
  std::vector<double> coefficients = {};
  /// Standard deviations of fx, fy, cx, cy [px], then of each coefficient; empty if unknown, all
  /// zero if the camera is exact.
  std::vector<double> sigmas = {};
  /// Upper triangle of the covariance of the same parameters, row by row; it takes precedence over
  /// `sigmas`. Empty if unknown: then errors are independent. See `set_lens_covariance`.
  std::vector<double> covariance = {};
  std::optional<Readout> readout = std::nullopt;                     ///< nullopt: unknown
  std::optional<ReadoutDirection> readout_direction = std::nullopt;  ///< nullopt: down

  bool operator==(const Camera&) const = default;
};

/// Diagonal field of view assumed for a camera without calibration [deg].
inline constexpr double kUsualView_deg = 70;

/// Returns a pinhole camera with its principal point in the image center and the focal length as a
/// multiple of the image diagonal.
Camera camera_of_focal(int width, int height, double focal_diagonals);
/// Returns the same from the diagonal field of view.
Camera camera_of_view(int width, int height, double diagonal_deg = kUsualView_deg);

/// Largest accepted distortion coefficient, and standard deviation of one [-].
inline constexpr double kLargestCoefficient = 1e6;
/// Returns true if the focal length is positive and at most 1e6 px.
bool is_focal_length(double focal_px);
bool are_coefficients(const std::vector<double>& coefficients);
/// Returns the reason why the lens model cannot have these coefficients; nullopt if it can.
std::optional<std::string> coefficient_fault(const Camera& camera);
/// Returns true if the principal point is within one image size of the image, or if the image size
/// is unknown.
bool has_near_principal_point(const Camera& camera);
inline constexpr double kLeastReadoutSigma_s = 1e-4;
/// Standard deviations of a typical calibration: of the focal length [focal lengths], and of the
/// principal point [image widths].
inline constexpr double kTypicalLensShare = 0.003;
/// With a standard deviation of 2 %, at least `kLeastReadoutSigma_s`.
Readout readout_of(double seconds);
/// Returns the unit vector along which the image is read.
Eigen::Vector2d readout_direction(const Camera& camera);
/// Returns the number of rows, or columns, that are read one after the other.
int readout_lines(const Camera& camera);
/// Returns the distance of a raw pixel from the middle row (or column) along the readout [rows].
double row_from_middle(const Camera& camera, const Eigen::Vector2d& raw_px);

/// Returns true for a symmetric, positive semidefinite matrix, up to the rounding in files.
bool is_covariance(const Eigen::MatrixXd& matrix);
/// Sets `covariance`, and `sigmas` from its diagonal.
void set_lens_covariance(Camera& camera, const Eigen::MatrixXd& covariance);
/// Returns the symmetric matrix with this upper triangle, row by row. Throws InputError if the
/// count fits no triangle.
Eigen::MatrixXd from_upper_triangle(const std::vector<double>& values);
/// Returns a root of the covariance, F F^T: one column per independent error of one standard
/// deviation. Without columns if the covariance is unknown; one zero column if the camera is exact.
Eigen::MatrixXd lens_root(const Camera& camera);

/// Throws InputError if a focal length is not positive, a number is not finite, the uncertainty is
/// not one of this camera's parameters, the sigma of a readout time is zero, or a readout time is
/// not below one second.
void check_camera(const Camera& camera);

/// Returns K of the undistorted image, 3x3 [px].
Eigen::Matrix3d intrinsic_matrix(const Camera& camera);

/// Returns the unit of thresholds on pixels, by the image's diagonal (engine/method.md, "Scale of
/// pixels"): 1 from 512x512 to 1280x960, proportional below and above. A principal point stands for
/// half the image.
double pixel_unit(const Camera& camera);
double pixel_unit(const Eigen::Matrix3d& K);

/// Returns the raw pixel of a point in the camera frame (z > 0); NaN beyond the valid radius.
Eigen::Vector2d project(const Camera& camera, const Eigen::Vector3d& point_c);

/// Returns the raw pixel of an undistorted one; NaN beyond the valid radius.
Eigen::Vector2d distort(const Camera& camera, const Eigen::Vector2d& undistorted_px);

/// Returns the undistorted pixel of a raw one, by Newton's method to 1e-10 px. NaN if there is no
/// inverse within the valid radius (far outside of the calibrated area).
Eigen::Vector2d undistort(const Camera& camera, const Eigen::Vector2d& raw_px);

/// Returns the first-order changes of an undistorted pixel, with its raw pixel and K fixed, by
/// `errors` of the parameters (parameters x n, as `lens_root` returns them); 2 x n. Throws
/// InputError if the camera has fewer parameters.
Eigen::Matrix2Xd undistortion_moves_px(const Camera& camera,
                                       const Eigen::MatrixXd& errors,
                                       const Eigen::Vector2d& undistorted_px);

}  // namespace gpo
