// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/recording/calibration_file.h"

#include "engine/recording/text_file.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <fmt/format.h>

namespace gpo {

namespace {

std::string count_of(const std::vector<double>& values) {
  return std::to_string(values.size()) + " numbers";
}

void check_model(const YamlEntry& root) {
  const auto entry = find(root, "camera_model");
  if (!entry) return;
  const std::string model = lower_case(text(*entry, "pinhole"));
  if (model != "pinhole") yaml_fail(*entry, fmt::format("\"{}\"", model), "pinhole");
}

Distortion distortion_model(const YamlEntry& entry) {
  const std::string expected = "radial-tangential, equidistant or none";
  const std::string model = lower_case(text(entry, expected));
  if (model == "none" || model == "no") return Distortion::none;
  for (const char* same : {"radial-tangential", "radtan", "plumb_bob", "rational_polynomial"}) {
    if (model == same) return Distortion::radial_tangential;
  }
  for (const char* same : {"equidistant", "fisheye"}) {
    if (model == same) return Distortion::equidistant;
  }
  yaml_fail(entry, fmt::format("\"{}\"", model), expected);
}

void set_coefficients(Camera& camera, const YamlEntry& entry) {
  const std::vector<double> values = numbers(entry);
  const std::size_t n = values.size();
  if (camera.distortion == Distortion::none) {
    if (std::any_of(values.begin(), values.end(), [](double k) { return k != 0; })) {
      yaml_fail(entry, count_of(values), "none for distortion model none");
    }
    return;
  }
  if (camera.distortion == Distortion::equidistant && n != 4) {
    yaml_fail(entry, count_of(values), "4 (k1, k2, k3, k4) for distortion model equidistant");
  }
  if (camera.distortion == Distortion::radial_tangential && n != 4 && n != 5 && n != 8) {
    yaml_fail(entry,
              count_of(values),
              "4, 5 or 8 (k1, k2, p1, p2, k3, ...) for distortion model radial-tangential");
  }
  camera.coefficients = values;
}

void set_resolution(Camera& camera, const YamlEntry& entry, double width, double height) {
  constexpr double kMost = 1e5;
  const bool whole = width == std::floor(width) && height == std::floor(height);
  if (!whole || width < 1 || height < 1 || width > kMost || height > kMost) {
    yaml_fail(entry, "a size that no picture has", "[width, height] in pixels");
  }
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
}

void set_intrinsics(
    Camera& camera, const YamlEntry& entry, double fx, double fy, double cx, double cy) {
  if (fx <= 0 || fy <= 0) {
    yaml_fail(entry, "a focal length that is not positive", "fx, fy > 0 in pixels");
  }
  const bool inside =
      cx > -camera.width && cx < 2 * camera.width && cy > -camera.height && cy < 2 * camera.height;
  if (!inside) {
    yaml_fail(entry,
              "a principal point far outside of the picture",
              "cx, cy in pixels, near the middle of it");
  }
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
}

/// EuRoC's keys and Kalibr's, which differ in one name only.
Camera euroc_camera(const YamlEntry& root) {
  Camera camera;
  const auto resolution = at(root, "resolution", "[width, height]");
  const auto size = numbers(resolution, 2, "2 (width, height)");
  set_resolution(camera, resolution, size[0], size[1]);
  const auto intrinsics = at(root, "intrinsics", "[fx, fy, cx, cy]");
  const auto k = numbers(intrinsics, 4, "4 (fx, fy, cx, cy)");
  set_intrinsics(camera, intrinsics, k[0], k[1], k[2], k[3]);
  camera.distortion =
      distortion_model(at(root, "distortion_model", "radial-tangential, equidistant or none"));
  const auto euroc_key = find(root, "distortion_coefficients");
  const auto kalibr_key = find(root, "distortion_coeffs");
  if (euroc_key || kalibr_key) {
    set_coefficients(camera, euroc_key ? *euroc_key : *kalibr_key);
  } else if (camera.distortion != Distortion::none) {
    at(root, "distortion_coefficients", "a list of numbers");
  }
  return camera;
}

Camera opencv_camera(const YamlEntry& root) {
  Camera camera;
  const auto width = at(root, "image_width", "a number of pixels");
  const auto height = at(root, "image_height", "a number of pixels");
  set_resolution(camera, width, number(width), number(height));
  const auto matrix = at(root, "camera_matrix", "a 3x3 matrix");
  const auto k = numbers(matrix, 9, "9 (a 3x3 matrix)");
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1) {
    yaml_fail(matrix, "another matrix", "[fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  }
  set_intrinsics(camera, matrix, k[0], k[4], k[2], k[5]);
  const auto coefficients = find(root, "distortion_coefficients");
  if (!coefficients) return camera;
  const auto fisheye = find(root, "fisheye_model");
  camera.distortion =
      fisheye && number(*fisheye) != 0 ? Distortion::equidistant : Distortion::radial_tangential;
  if (const auto model = find(root, "distortion_model")) {
    camera.distortion = distortion_model(*model);
  }
  set_coefficients(camera, *coefficients);
  return camera;
}

}  // namespace

Pose rigid_motion(const YamlEntry& entry) {
  const auto values = numbers(entry, 16, "16 (a 4x4 matrix, row by row)");
  const Eigen::Matrix4d T =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-2;  // files are written with few digits
  if ((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kTolerance ||
      R.determinant() < 0) {
    yaml_fail(entry, "a matrix that is no rotation", "an orthonormal right-handed 3x3 part");
  }
  if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1)) {
    yaml_fail(entry, "another last row", "0, 0, 0, 1");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return {svd.matrixU() * svd.matrixV().transpose(), T.topRightCorner<3, 1>()};
}

Calibration read_calibration(const std::filesystem::path& file) {
  const YamlEntry whole = load_yaml(file);
  const auto kalibr = find(whole, "cam0");
  const YamlEntry& root = kalibr ? *kalibr : whole;
  check_model(root);
  Calibration result;
  result.camera = find(root, "camera_matrix") ? opencv_camera(root) : euroc_camera(root);
  if (const auto T_BS = find(root, "T_BS")) {
    result.T_body_camera = rigid_motion(*T_BS);
  } else if (const auto T_cam_imu = find(root, "T_cam_imu")) {
    result.T_body_camera = inverse(rigid_motion(*T_cam_imu));
  }
  if (const auto shift = find(root, "timeshift_cam_imu")) {
    result.time_offset_ns = std::llround(number(*shift) * 1e9);
  }
  if (const auto rate = find(root, "rate_hz")) {
    result.rate_hz = number(*rate);
    if (*result.rate_hz <= 0) yaml_fail(*rate, "a rate that is not positive", "pictures a second");
  }
  return result;
}

}  // namespace gpo
