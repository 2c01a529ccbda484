// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/limits.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/decompositions.h"
#include "engine/recording/companions/companion_files.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace gpo {
namespace {

using Names = const char*;  ///< separated by blanks

/// Names of OpenCV's samples, of ROS, and common ones; OpenCV itself does not define them.
constexpr Names kMatrix = "camera_matrix cameraMatrix Camera_Matrix K M1 mtx";
constexpr Names kCoefficients =
    "distortion_coefficients Distortion_Coefficients distCoeffs dist_coeffs distortion D D1 dist";
constexpr Names kWidth = "image_width image_Width imageWidth width";
constexpr Names kHeight = "image_height image_Height imageHeight height";
constexpr Names kSize = "image_size imageSize resolution size";

constexpr double kMostShift_s = 3600;
/// From one image in 100 s to a high-speed camera, so that time stamps fit and differ.
constexpr double kLeastImageRate_hz = 0.01;
constexpr double kMostImageRate_hz = 100'000;

std::optional<YamlEntry> find_any(const YamlEntry& map, Names names) {
  for (const std::string& name : split(names, ' '))
    if (auto entry = find(map, name)) return entry;
  return std::nullopt;
}

std::string count_of(const std::vector<double>& values) { return counted(values.size(), "number"); }

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
  for (const char* same :
       {"radial-tangential", "radtan", "plumb_bob", "rational_polynomial", "brown_conrady"})
    if (model == same) return Distortion::radial_tangential;
  for (const char* same : {"equidistant", "fisheye", "kannala_brandt"})
    if (model == same) return Distortion::equidistant;
  yaml_fail(entry, fmt::format("\"{}\"", model), expected);
}

void set_coefficients(Camera& camera, const YamlEntry& entry) {
  const std::vector<double> values = numbers(entry);
  const std::size_t n = values.size();
  if (camera.distortion == Distortion::none) {
    if (std::ranges::any_of(values, [](double k) { return k != 0; }))
      yaml_fail(entry, count_of(values), "none for distortion model none");
    return;
  }
  if (camera.distortion == Distortion::equidistant && n != 4)
    yaml_fail(entry, count_of(values), "4 (k1, k2, k3, k4) for distortion model equidistant");
  static const std::set<std::size_t> kCounts = {4, 5, 8, 12, 14};
  if (camera.distortion == Distortion::radial_tangential && !kCounts.contains(n))
    yaml_fail(entry,
              count_of(values),
              "4, 5, 8, 12 or 14 (k1, k2, p1, p2, k3, ...) for distortion model radial-tangential");
  if (!are_coefficients(values))
    yaml_fail(entry, "an implausible coefficient", "magnitudes of the order of 1");
  camera.coefficients = values;
}

void set_resolution(Camera& camera, const YamlEntry& entry, double width, double height) {
  constexpr double kMost = 1e5;
  const bool whole = width == std::floor(width) && height == std::floor(height);
  if (!whole || width < 1 || height < 1 || width > kMost || height > kMost)
    yaml_fail(entry, fmt::format("{:g}x{:g}", width, height), "[width, height] in pixels");
  camera.width = static_cast<int>(width);
  camera.height = static_cast<int>(height);
}

void set_intrinsics(Camera& camera, const YamlEntry& entry, const std::array<double, 4>& k) {
  const auto& [fx, fy, cx, cy] = k;
  if (!is_focal_length(fx) || !is_focal_length(fy))
    yaml_fail(entry, fmt::format("{:g}, {:g}", fx, fy), "plausible fx, fy > 0 in pixels");
  camera.fx = fx;
  camera.fy = fy;
  camera.cx = cx;
  camera.cy = cy;
  if (!has_near_principal_point(camera))
    yaml_fail(entry, fmt::format("{:g}, {:g}", cx, cy), "cx, cy in pixels, near the image center");
}

void set_sigmas(Camera& camera, const YamlEntry& root) {
  const auto intrinsics = find(root, "intrinsics_sigma");
  if (!intrinsics) return;
  camera.sigmas = numbers(*intrinsics, 4, "4 (of fx, fy, cx, cy)");
  if (const auto entry = find(root, "distortion_coefficients_sigma")) {
    const std::vector<double> values = numbers(*entry);
    if (values.size() != camera.coefficients.size())
      yaml_fail(*entry, count_of(values), "one for each of the distortion coefficients");
    camera.sigmas.insert(camera.sigmas.end(), values.begin(), values.end());
  }
  const auto no_sigma = [](double sigma) { return !(sigma >= 0 && sigma < kLargestCoefficient); };
  if (std::ranges::any_of(camera.sigmas, no_sigma))
    yaml_fail(*intrinsics, "an implausible standard deviation", "numbers from 0 on");
}

void set_covariance(Camera& camera, const YamlEntry& root) {
  const auto entry = find(root, "intrinsics_covariance");
  if (!entry) return;
  const std::size_t size = 4 + camera.coefficients.size();
  const std::size_t count = size * (size + 1) / 2;
  const auto values =
      numbers(*entry,
              count,
              fmt::format("{} (upper triangle, row by row, of fx, fy, cx, cy and {} coefficients)",
                          count,
                          size - 4));
  const Eigen::MatrixXd covariance = from_upper_triangle(values);
  const double largest = kLargestCoefficient * kLargestCoefficient;
  if (!is_covariance(covariance) || !(covariance.diagonal().maxCoeff() < largest))
    yaml_fail(*entry, "a matrix that is no covariance", "a positive semidefinite one");
  set_lens_covariance(camera, covariance);
}

void set_readout(Camera& camera, const YamlEntry& root) {
  if (const auto direction = find(root, "readout_direction")) {
    constexpr const char* kExpected = "down, left, up or right";
    const std::string key = text(*direction, kExpected);
    if (!std::ranges::count(ChoiceKeys<ReadoutDirection>::keys, key))
      yaml_fail(*direction, kExpected);
    camera.readout_direction = choice<ReadoutDirection>(key);
  }
  const auto entry = find(root, "readout_s");
  if (!entry) return;
  const double seconds = number(*entry);
  if (!(std::abs(seconds) < 1))
    yaml_fail(*entry, fmt::format("{:g}", seconds), "seconds from the first row to the last");
  camera.readout = readout_of(seconds);
  const auto sigma = find(root, "readout_sigma_s");
  if (!sigma) return;
  camera.readout->sigma_s = number(*sigma);
  if (!(camera.readout->sigma_s >= kAboveZero.least && camera.readout->sigma_s < 1))
    yaml_fail(*sigma, fmt::format("{:g}", camera.readout->sigma_s), "seconds above 0");
}

Camera euroc_camera(const YamlEntry& root) {
  Camera camera;
  const auto resolution = at(root, "resolution", "[width, height]");
  const auto size = numbers(resolution, 2, "2 (width, height)");
  set_resolution(camera, resolution, size[0], size[1]);
  const auto intrinsics = at(root, "intrinsics", "[fx, fy, cx, cy]");
  const auto k = numbers(intrinsics, 4, "4 (fx, fy, cx, cy)");
  set_intrinsics(camera, intrinsics, {k[0], k[1], k[2], k[3]});
  camera.distortion =
      distortion_model(at(root, "distortion_model", "radial-tangential, equidistant or none"));
  const auto euroc_key = find(root, "distortion_coefficients");
  const auto kalibr_key = find(root, "distortion_coeffs");
  if (euroc_key || kalibr_key)
    set_coefficients(camera, euroc_key ? *euroc_key : *kalibr_key);
  else if (camera.distortion != Distortion::none)
    at(root, "distortion_coefficients", "a list of numbers");
  return camera;
}

void set_opencv_size(Camera& camera, const YamlEntry& root) {
  if (const auto size = find_any(root, kSize)) {
    const auto s = numbers(*size, 2, "2 (width, height)");
    return set_resolution(camera, *size, s[0], s[1]);
  }
  const auto width = find_any(root, kWidth);
  const auto height = find_any(root, kHeight);
  if (!width && !height) return;
  const char* const kExpected = "a number of pixels";
  if (!width) at(root, "image_width", kExpected);
  if (!height) at(root, "image_height", kExpected);
  set_resolution(camera, *width, number(*width), number(*height));
}

Camera opencv_camera(const YamlEntry& root, const YamlEntry& matrix) {
  Camera camera;
  set_opencv_size(camera, root);
  const auto k = numbers(matrix, 9, "9 (a 3x3 matrix)");
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    yaml_fail(matrix, "another matrix", "[fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  set_intrinsics(camera, matrix, {k[0], k[4], k[2], k[5]});
  const auto coefficients = find_any(root, kCoefficients);
  if (!coefficients) return camera;
  const auto fisheye = find(root, "fisheye_model");
  camera.distortion =
      fisheye && number(*fisheye) != 0 ? Distortion::equidistant : Distortion::radial_tangential;
  if (const auto model = find(root, "distortion_model"))
    camera.distortion = distortion_model(*model);
  set_coefficients(camera, *coefficients);
  return camera;
}

std::vector<std::string> calibration_names() {
  std::vector<std::string> names;
  constexpr Names kStems =
      "camera sensor camchain-imucam camchain calibration camera_calibration calib intrinsics "
      "out_camera_data";
  for (const std::string& stem : split(kStems, ' '))
    for (const char* extension : {".yaml", ".yml", ".xml", ".json"})
      names.push_back(stem + extension);
  return names;
}

/// Kalibr adds the bag's name: "camchain-imucam-desk.yaml", "desk-camchain.yaml".
bool is_camchain(const fs::path& file) {
  const std::string name = file.filename().string();
  return name.find("camchain") != std::string::npos && file.extension() == ".yaml";
}

}  // namespace

Pose rigid_motion(const YamlEntry& entry) {
  const auto values = numbers(entry, 16, "16 (a 4x4 matrix, row by row)");
  const Eigen::Matrix4d T =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-2;  // for files with few digits
  if ((R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() > kTolerance ||
      R.determinant() < 0)
    yaml_fail(entry, "a matrix that is no rotation", "an orthonormal right-handed 3x3 part");
  if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    yaml_fail(entry, "another last row", "0, 0, 0, 1");
  return {nearest_rotation(R), T.topRightCorner<3, 1>()};
}

bool is_image_rate(double rate_hz) {
  return rate_hz >= kLeastImageRate_hz && rate_hz <= kMostImageRate_hz;
}

const char* distortion_name(Distortion distortion) {
  if (distortion == Distortion::none) return "none";
  return distortion == Distortion::equidistant ? "equidistant" : "radial-tangential";
}

Calibration read_calibration(const fs::path& file) {
  const YamlEntry whole = is_xml(file) ? load_opencv_xml(file) : load_yaml(file);
  const auto kalibr = find(whole, "cam0");
  const YamlEntry& root = kalibr ? *kalibr : whole;
  check_model(root);
  Calibration result;
  result.name = file.filename().string();
  const auto matrix = find_any(root, kMatrix);
  result.camera = matrix ? opencv_camera(root, *matrix) : euroc_camera(root);
  set_sigmas(result.camera, root);
  set_covariance(result.camera, root);
  set_readout(result.camera, root);
  if (const auto T_BS = find(root, "T_BS"))
    result.T_body_camera = rigid_motion(*T_BS);
  else if (const auto T_cam_imu = find(root, "T_cam_imu"))
    result.T_body_camera = inverse(rigid_motion(*T_cam_imu));
  if (const auto shift = find(root, "timeshift_cam_imu")) {
    const double seconds = number(*shift);
    if (std::abs(seconds) > kMostShift_s) yaml_fail(*shift, "seconds, at most 3600");
    result.time_offset_ns = std::llround(seconds * 1e9);
  }
  if (const auto source = find(root, "source"))
    for (const CameraSource one : {CameraSource::self_calibrated, CameraSource::guess})
      if (text(*source, "a name") == to_string(one)) result.source = one;
  if (const auto rate = find(root, "rate_hz")) {
    result.rate_hz = number(*rate);
    if (!is_image_rate(*result.rate_hz))
      yaml_fail(
          *rate,
          fmt::format("{} to {:.0f} images per second", kLeastImageRate_hz, kMostImageRate_hz));
  }
  return result;
}

std::optional<fs::path> find_calibration(const fs::path& folder) {
  for (const std::string& name : calibration_names())
    if (is_file(folder / name)) return folder / name;
  const auto chains = files_of_kind(folder, is_camchain);
  return chains.empty() ? std::nullopt : std::optional(chains.front());
}

fs::path calibration_in(const fs::path& folder) {
  if (const auto file = find_calibration(folder)) return *file;
  refuse(folder,
         "found no calibration, expected camera.yaml or another file of EuRoC, OpenCV or "
         "Kalibr; `gpo-inspector calibrate` makes one");
}

}  // namespace gpo
