// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/limits.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/geometry/decompositions.h"
#include "engine/recording/companions/lens_formats.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/ranges.h>

namespace gpo {
namespace {

using Names = const char*;  ///< separated by blanks

/// Names of OpenCV's samples, of ROS, and common ones; OpenCV itself does not define them.
constexpr Names kMatrix = "camera_matrix cameraMatrix Camera_Matrix K k M1 mtx";
constexpr Names kWidth = "image_width image_Width imageWidth width";
constexpr Names kHeight = "image_height image_Height imageHeight height";
constexpr Names kSize = "image_size imageSize resolution size";

std::optional<YamlEntry> find_any(const YamlEntry& map, Names names) {
  for (const std::string& name : split(names, ' '))
    if (auto entry = find(map, name)) return entry;
  return std::nullopt;
}

std::string count_of(const std::vector<double>& values) { return counted(values.size(), "number"); }

std::string model_names() {
  std::string names;
  for (const LensModel& model : lens_models())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", model.name);
  return names;
}

Distortion distortion_model(const YamlEntry& entry) {
  using enum Distortion;
  static const std::map<std::string, Distortion> kOtherNames = {
      {"no", none},
      {"radtan", radial_tangential},
      {"plumb_bob", radial_tangential},
      {"rational_polynomial", radial_tangential},
      {"brown_conrady", radial_tangential},
      {"equi", equidistant},
      {"fisheye", equidistant},
      {"kannala_brandt", equidistant},
      {"fov", field_of_view}};
  const std::string model = lower_case(text(entry, model_names()));
  if (const auto other = kOtherNames.find(model); other != kOtherNames.end()) return other->second;
  const auto ours = std::ranges::find(lens_models(), model, &LensModel::name);
  if (ours == lens_models().end()) yaml_fail(entry, fmt::format("\"{}\"", model), model_names());
  return ours->distortion;
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
    yaml_fail(*entry,
              fmt::format("{:g}", seconds),
              "seconds from the first row to the last, less than 1");
  camera.readout = readout_of(seconds);
  const auto sigma = find(root, "readout_sigma_s");
  if (!sigma) return;
  camera.readout->sigma_s = number(*sigma);
  if (!(camera.readout->sigma_s >= kAboveZero.least && camera.readout->sigma_s < 1))
    yaml_fail(
        *sigma, fmt::format("{:g}", camera.readout->sigma_s), "seconds above 0 and less than 1");
}

/// A camera model of Kalibr: its parameters before the focal lengths and the principal point.
struct KalibrModel {
  const char* name;
  const char* parameters;
  std::size_t count;
  Distortion distortion;
};
constexpr std::array<KalibrModel, 4> kKalibrModels = {
    {{"pinhole", "fx, fy, cx, cy", 0, Distortion::none},
     {"omni", "xi, fx, fy, cx, cy", 1, Distortion::omnidirectional},
     {"eucm", "alpha, beta, fx, fy, cx, cy", 2, Distortion::extended_unified},
     {"ds", "xi, alpha, fx, fy, cx, cy", 2, Distortion::double_sphere}}};

const KalibrModel& kalibr_model(const YamlEntry& root) {
  const auto entry = find(root, "camera_model");
  if (!entry) return kKalibrModels[0];
  const std::string name = lower_case(text(*entry, "pinhole"));
  const auto model = std::ranges::find(kKalibrModels, name, &KalibrModel::name);
  if (model == kKalibrModels.end())
    yaml_fail(*entry, fmt::format("\"{}\"", name), "pinhole, omni, eucm or ds");
  return *model;
}

/// Returns the coefficients of the key `distortion_model`; empty for none.
std::vector<double> euroc_coefficients(Camera& camera, const YamlEntry& root) {
  camera.distortion = distortion_model(at(root, "distortion_model", model_names()));
  const auto entry = find_coefficients(root);
  check_distortion_is_read(root, entry);
  if (entry) {
    set_coefficients(camera, *entry, numbers(*entry));
  } else if (camera.distortion != Distortion::none) {
    at(root, "distortion_coefficients", "a list of numbers");
  }
  return camera.coefficients;
}

Camera euroc_camera(const YamlEntry& root) {
  Camera camera;
  const auto resolution = at(root, "resolution", "[width, height]");
  const auto size = numbers(resolution, 2, "2 (width, height)");
  set_resolution(camera, resolution, size[0], size[1]);
  const KalibrModel& model = kalibr_model(root);
  const auto intrinsics = at(root, "intrinsics", fmt::format("[{}]", model.parameters));
  const auto k = numbers(
      intrinsics, 4 + model.count, fmt::format("{} ({})", 4 + model.count, model.parameters));
  const auto pinhole = std::span(k).last<4>();
  set_intrinsics(camera, intrinsics, {pinhole[0], pinhole[1], pinhole[2], pinhole[3]});
  const auto beyond = euroc_coefficients(camera, root);
  if (model.distortion == Distortion::none) {
    // With Kalibr's name of the model, the focal lengths are the authors'.
    if (lower_case(text(at(root, "distortion_model", ""), "")) == "fov")
      convert_focal_lengths(camera);
    return camera;
  }
  const bool omni = model.distortion == Distortion::omnidirectional;
  if (camera.distortion != Distortion::none &&
      !(omni && camera.distortion == Distortion::radial_tangential && beyond.size() == 4))
    yaml_fail(at(root, "distortion_model", ""),
              fmt::format("{} with {}",
                          lens_model(camera.distortion).name,
                          counted(beyond.size(), "coefficient")),
              omni ? "none or radtan with 4 coefficients for omni"
                   : fmt::format("none for {}", model.name));
  std::vector<double> all(k.begin(), k.begin() + static_cast<std::ptrdiff_t>(model.count));
  all.insert(all.end(), beyond.begin(), beyond.end());
  if (omni) all.resize(5);
  camera.distortion = model.distortion;
  set_coefficients(camera, intrinsics, all);
  convert_focal_lengths(camera);
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

/// Reads the keys of OpenCV's FileStorage and of ROS. `xi` is of cv::omnidir.
Camera opencv_camera(const YamlEntry& root) {
  const YamlEntry matrix = *find_any(root, kMatrix);
  Camera camera;
  set_opencv_size(camera, root);
  const auto k = numbers(matrix, 9, "9 (a 3x3 matrix)");
  if (k[1] != 0 || k[3] != 0 || k[6] != 0 || k[7] != 0 || k[8] != 1)
    yaml_fail(matrix, "another matrix", "[fx, 0, cx, 0, fy, cy, 0, 0, 1]");
  set_intrinsics(camera, matrix, {k[0], k[4], k[2], k[5]});
  const auto entry = find_coefficients(root);
  check_distortion_is_read(root, entry);
  std::vector<double> coefficients = entry ? numbers(*entry) : std::vector<double>{};
  if (const auto xi = find(root, "xi")) {
    camera.distortion = Distortion::omnidirectional;
    const bool one = xi->node.IsScalar();
    coefficients.insert(coefficients.begin(), one ? number(*xi) : numbers(*xi, 1, "1").front());
    set_coefficients(camera, *xi, coefficients);
    convert_focal_lengths(camera);
    return camera;
  }
  const auto model = find(root, "distortion_model");
  if (!entry && model && distortion_model(*model) != Distortion::none)
    at(root, "distortion_coefficients", "a list of numbers");
  if (coefficients.empty()) return camera;
  const auto fisheye = find(root, "fisheye_model");
  camera.distortion =
      fisheye && number(*fisheye) != 0 ? Distortion::equidistant : Distortion::radial_tangential;
  if (model) camera.distortion = distortion_model(*model);
  set_coefficients(camera, *entry, coefficients);
  return camera;
}

/// Reads the keys of EuRoC and Kalibr that do not depend on the lens model.
Calibration with_body(const YamlEntry& root, const Camera& camera) {
  Calibration result;
  result.camera = camera;
  if (const auto T_BS = find(root, "T_BS"))
    result.T_body_camera = rigid_motion(*T_BS);
  else if (const auto T_cam_imu = find(root, "T_cam_imu"))
    result.T_body_camera = inverse(rigid_motion(*T_cam_imu));
  else if (const auto T_imu_cam = find(root, "T_imu_cam"))
    result.T_body_camera = rigid_motion(*T_imu_cam);
  if (const auto shift = find(root, "timeshift_cam_imu")) set_time_offset(result, *shift);
  return result;
}

Calibration read_euroc_lens(const YamlEntry& root) { return with_body(root, euroc_camera(root)); }

Calibration read_opencv_lens(const YamlEntry& root) { return with_body(root, opencv_camera(root)); }

Calibration read_kalibr(const YamlEntry& root) {
  const YamlEntry cam0 = at(root, "cam0", "a camera");
  return find_any(cam0, kMatrix) ? read_opencv_lens(cam0) : read_euroc_lens(cam0);
}

}  // namespace

const char* distortion_name(Distortion distortion) { return lens_model(distortion).name; }

std::span<const LensFormat> lens_formats() {
  static constexpr auto kFormats = std::to_array<LensFormat>(
      {{"Basalt", "value0", read_basalt},
       {"Kalibr", "cam0", read_kalibr},
       {"ORB-SLAM", "Camera1.fx Camera.fx Camera.type", read_orb_slam},
       {"VINS-Fusion", "cam0_calib", read_vins_fusion},
       {"VINS and camodocal", "projection_parameters mirror_parameters model_type", read_camodocal},
       {"nerfstudio", "fl_x camera_angle_x", read_nerfstudio},
       {"NICE-SLAM", "camera/fx", read_nice_slam},
       {"KITTI", "P0 P1 P2 P3 P_rect_00", read_kitti},
       {"OpenCV or ROS", kMatrix, read_opencv_lens},
       {"EuRoC",
        "intrinsics resolution distortion_model distortion_coefficients distortion_coeffs "
        "camera_model sensor_type",
        read_euroc_lens}});
  return kFormats;
}

Calibration read_calibration(const fs::path& file) {
  if (const std::string bytes = read_file(file, limits().file_bytes);
      const LensTable* table = lens_table_of(file, bytes)) {
    Calibration result = table->read(file, bytes);
    result.format = table->name;
    result.name = file.filename().string();
    return result;
  }
  const YamlEntry root = load_lens_file(file);
  const auto kalibr = find(root, "cam0");
  const LensFormat* format = lens_format_of(root);
  if (format == nullptr) {
    std::vector<std::string> formats;
    for (const LensFormat& one : lens_formats())
      formats.push_back(fmt::format("`{}` ({})", split(one.keys, ' ').front(), one.name));
    refuse(file, "found no key of a known lens file, expected {}", fmt::join(formats, ", "));
  }
  Calibration result = format->read(root);
  result.format = format->name;
  result.name = file.filename().string();
  const YamlEntry& camera = kalibr && kalibr->node.IsMap() ? *kalibr : root;
  set_sigmas(result.camera, camera);
  set_covariance(result.camera, camera);
  set_readout(result.camera, camera);
  if (const auto source = find(camera, "source"))
    for (const CameraSource one : {CameraSource::self_calibrated, CameraSource::guess})
      if (text(*source, "a name") == to_string(one)) result.source = one;
  if (const auto rate = find(camera, "rate_hz")) set_rate(result, *rate);
  return result;
}

}  // namespace gpo
