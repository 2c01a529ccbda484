// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Lens files of SLAM systems and of programs for reconstruction.
#include "engine/recording/companions/lens_formats.h"

#include "engine/files/refuse.h"
#include "engine/files/text_file.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

namespace gpo {
namespace {

constexpr const char* kPixels = "a number of pixels";
constexpr const char* kNumber = "a number";

/// Follows keys and numbers of list items: "value0/resolution/0". Returns nullopt if one is
/// missing.
std::optional<YamlEntry> find_path(const YamlEntry& root, const std::string& path) {
  const std::size_t slash = path.find('/');
  const std::string part = path.substr(0, slash);
  const auto index = parse_integer(part);
  const YAML::Node& node = root.node;
  const bool item = index && node.IsSequence() && *index < std::ssize(node);
  if (!item && (!node.IsMap() || !node[part])) return std::nullopt;
  // A new entry: assigning to a YAML::Node would change the document.
  const YamlEntry entry = below(root, part, item ? node[*index] : node[part]);
  return slash == std::string::npos ? entry : find_path(entry, path.substr(slash + 1));
}

YamlEntry at_path(const YamlEntry& root, const std::string& path, const std::string& expected) {
  if (auto entry = find_path(root, path)) return *entry;
  std::string key = path;
  std::ranges::replace(key, '/', '.');
  yaml_fail(below(root, key, YAML::Node()), "no value", expected);
}

/// Returns the numbers of several keys, which `prefix` precedes: "fx fy cx cy".
std::vector<double> numbers_at(const YamlEntry& root,
                               const std::string& prefix,
                               const std::string& keys) {
  std::vector<double> values;
  for (const std::string& key : split(keys, ' '))
    values.push_back(number(at_path(root, prefix + key, kNumber)));
  return values;
}

/// Sets a resolution that may be missing; the images then determine it.
void set_size(Camera& camera, const YamlEntry& root, const char* width, const char* height) {
  const auto w = find_path(root, width), h = find_path(root, height);
  if (!w && !h) return;
  set_resolution(camera,
                 w ? *w : *h,
                 number(at_path(root, width, kPixels)),
                 number(at_path(root, height, kPixels)));
}

void set_pinhole(Camera& camera, const YamlEntry& place, const std::vector<double>& k) {
  set_intrinsics(camera, place, {k[0], k[1], k[2], k[3]});
}

/// Sets a lens model with the authors' focal lengths.
void set_lens(Camera& camera,
              const YamlEntry& place,
              Distortion distortion,
              std::vector<double> coefficients) {
  camera.distortion = distortion;
  if (distortion == Distortion::none) return;
  set_coefficients(camera, place, std::move(coefficients));
  convert_focal_lengths(camera);
}

/// A lens model of a program: its name and the keys of the lens in the order of our coefficients.
struct NamedLens {
  const char* name;
  Distortion distortion;
  const char* pinhole;       ///< keys of fx, fy, cx, cy
  const char* coefficients;  ///< their keys; "" if there are none
};

NamedLens lens_named(std::span<const NamedLens> lenses,
                     const YamlEntry& entry,
                     const std::string& name) {
  const auto lens = std::ranges::find(lenses, name, &NamedLens::name);
  if (lens != lenses.end()) return *lens;
  std::string names;
  for (const NamedLens& one : lenses)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", one.name);
  yaml_fail(entry, fmt::format("\"{}\"", name), names);
}

/// Reads a named lens from keys below `prefix`.
void set_named_lens(Camera& camera,
                    const YamlEntry& root,
                    const std::string& prefix,
                    const NamedLens& lens) {
  const std::string first = split(lens.pinhole, ' ').front();
  const YamlEntry place = at_path(root, prefix + first, kNumber);
  set_pinhole(camera, place, numbers_at(root, prefix, lens.pinhole));
  set_lens(camera, place, lens.distortion, numbers_at(root, prefix, lens.coefficients));
}

constexpr const char* kPinholeKeys = "fx fy cx cy";

/// Parses a large JSON of nerfstudio without the list of its images.
YamlEntry without_frames(const fs::path& file) {
  nlohmann::ordered_json json = read_json(file);
  if (json.is_object()) json.erase("frames");
  const std::string rest = json_text(json, 0);
  if (rest.size() > limits().hand_bytes)
    fail_at(file, "a large file", "a lens file of at most 1 MiB");
  return {file, "", YAML::Load(rest)};
}

}  // namespace

/// https://gitlab.com/VladyslavUsenko/basalt, calibration.hpp: T_imu_cam maps camera to IMU.
Calibration read_basalt(const YamlEntry& root) {
  using enum Distortion;
  static constexpr auto kLenses = std::to_array<NamedLens>(
      {{"pinhole", none, kPinholeKeys, ""},
       {"pinhole-radtan8", radial_tangential, kPinholeKeys, "k1 k2 p1 p2 k3 k4 k5 k6"},
       {"kb4", equidistant, kPinholeKeys, "k1 k2 k3 k4"},
       {"ds", double_sphere, kPinholeKeys, "xi alpha"},
       {"eucm", extended_unified, kPinholeKeys, "alpha beta"},
       {"ucm", extended_unified, kPinholeKeys, "alpha"},
       {"fov", field_of_view, kPinholeKeys, "w"}});
  Calibration result;
  const auto type = at_path(root, "value0/intrinsics/0/camera_type", "a camera type");
  const NamedLens lens = lens_named(kLenses, type, text(type, "a camera type"));
  const std::string prefix = "value0/intrinsics/0/intrinsics/";
  if (const auto camera = find_path(root, "value0/intrinsics/0/intrinsics"))
    check_distortion_is_read(*camera, std::nullopt, lens.coefficients);
  set_size(result.camera, root, "value0/resolution/0/0", "value0/resolution/0/1");
  if (lens.name == std::string_view("ucm")) {
    const YamlEntry alpha = at_path(root, prefix + "alpha", kNumber);
    set_pinhole(result.camera, alpha, numbers_at(root, prefix, lens.pinhole));
    set_lens(result.camera, alpha, extended_unified, {number(alpha), 1});
  } else {
    set_named_lens(result.camera, root, prefix, lens);
  }
  if (const auto T = find_path(root, "value0/T_imu_cam/0")) {
    const auto v = numbers_at(*T, "", "px py pz qw qx qy qz");
    const Eigen::Quaterniond q(v[3], v[4], v[5], v[6]);
    if (!(std::abs(q.norm() - 1) <= 1e-2))
      yaml_fail(*T, fmt::format("a quaternion of norm {:g}", q.norm()), "a unit quaternion");
    result.T_body_camera = Pose{q.normalized().toRotationMatrix(), {v[0], v[1], v[2]}};
  }
  if (const auto offset = find_path(root, "value0/cam_time_offset_ns"))
    result.time_offset_ns = integer(*offset, "nanoseconds");
  return result;
}

/// UZ-SLAMLab/ORB_SLAM3, Calibration_Tutorial: Camera1 since version 1.0, Camera before.
Calibration read_orb_slam(const YamlEntry& root) {
  using enum Distortion;
  static constexpr auto kLenses =
      std::to_array<NamedLens>({{"PinHole", radial_tangential, kPinholeKeys, "k1 k2 p1 p2"},
                                {"KannalaBrandt8", equidistant, kPinholeKeys, "k1 k2 k3 k4"},
                                {"Rectified", none, kPinholeKeys, ""}});
  Calibration result;
  Camera& camera = result.camera;
  const bool old = !find(root, "Camera1.fx") && find(root, "Camera.fx");
  const std::string prefix = old ? "Camera." : "Camera1.";
  check_distortion_is_read(root, std::nullopt);
  const auto type = find(root, "Camera.type");
  NamedLens lens = type ? lens_named(kLenses, *type, text(*type, "a camera type")) : kLenses[0];
  // Settings.cc reads the distortion of a pinhole only if it exists.
  const auto is_missing = [&](const std::string& key) { return !find(root, prefix + key); };
  if (lens.distortion == radial_tangential &&
      std::ranges::all_of(split("k1 k2 p1 p2 k3", ' '), is_missing))
    lens = kLenses.back();
  set_size(camera, root, "Camera.width", "Camera.height");
  set_named_lens(camera, root, prefix, lens);
  const auto k3 = find(root, prefix + "k3");
  if (k3 && camera.distortion == radial_tangential) camera.coefficients.push_back(number(*k3));
  for (const char* key : {"IMU.T_b_c1", "Tbc"})
    if (const auto T = find(root, key)) result.T_body_camera = rigid_motion(*T);
  if (const auto rate = find(root, "Camera.fps")) set_rate(result, *rate);
  return result;
}

/// hengli/camodocal: the matrices of the projection follow the distortion.
Calibration read_camodocal(const YamlEntry& root) {
  using enum Distortion;
  static constexpr const char* kPinhole =
      "projection_parameters/fx projection_parameters/fy projection_parameters/cx "
      "projection_parameters/cy";
  static constexpr auto kLenses = std::to_array<NamedLens>(
      {{"PINHOLE",
        radial_tangential,
        kPinhole,
        "distortion_parameters/k1 distortion_parameters/k2 distortion_parameters/p1 "
        "distortion_parameters/p2"},
       {"PINHOLE_FULL",
        radial_tangential,
        kPinhole,
        "distortion_parameters/k1 distortion_parameters/k2 distortion_parameters/p1 "
        "distortion_parameters/p2 distortion_parameters/k3 distortion_parameters/k4 "
        "distortion_parameters/k5 distortion_parameters/k6"},
       {"MEI",
        omnidirectional,
        "projection_parameters/gamma1 projection_parameters/gamma2 projection_parameters/u0 "
        "projection_parameters/v0",
        "mirror_parameters/xi distortion_parameters/k1 distortion_parameters/k2 "
        "distortion_parameters/p1 distortion_parameters/p2"},
       {"KANNALA_BRANDT",
        equidistant,
        "projection_parameters/mu projection_parameters/mv projection_parameters/u0 "
        "projection_parameters/v0",
        "projection_parameters/k2 projection_parameters/k3 projection_parameters/k4 "
        "projection_parameters/k5"}});
  Calibration result;
  const auto type = at_path(root, "model_type", "PINHOLE, PINHOLE_FULL, MEI or KANNALA_BRANDT");
  const NamedLens lens = lens_named(kLenses, type, text(type, "a model"));
  check_distortion_is_read(root, find(root, "distortion_parameters"));
  set_size(result.camera, root, "image_width", "image_height");
  set_named_lens(result.camera, root, "", lens);
  const auto rotation = find(root, "extrinsicRotation");
  const auto translation = find(root, "extrinsicTranslation");
  if (rotation && translation) {
    const auto R = numbers(*rotation, 9, "9 (a 3x3 matrix, row by row)");
    const auto t = numbers(*translation, 3, "3 (x, y, z)");
    Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
    T.topLeftCorner<3, 3>() =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.data());
    T.topRightCorner<3, 1>() << t[0], t[1], t[2];
    result.T_body_camera = rigid_motion_of(*rotation, T);
  }
  if (const auto td = find(root, "td")) set_time_offset(result, *td);
  const auto rolling = find(root, "rolling_shutter");
  const auto readout = find(root, "rolling_shutter_tr");
  if (rolling && readout && number(*rolling) != 0)
    result.camera.readout = readout_of(number(*readout));
  return result;
}

std::optional<fs::path> named_camera_file(const YamlEntry& root) {
  const auto name = root.node.IsMap() ? find(root, "cam0_calib") : std::nullopt;
  if (!name) return std::nullopt;
  return folder_of(root.file) / fs::path(text(*name, "a file")).filename();
}

/// HKUST's VINS-Fusion: the lens is in another file.
Calibration read_vins_fusion(const YamlEntry& root) {
  const YamlEntry name = at(root, "cam0_calib", "a file");
  const fs::path file = *named_camera_file(root);
  if (!is_file(file)) yaml_fail(name, "no such file", "the camera's file in the same folder");
  const YamlEntry lens = load_lens_file(file);
  Calibration result = read_camodocal(lens);
  if (const auto T = find(root, "body_T_cam0")) result.T_body_camera = rigid_motion(*T);
  if (const auto td = find(root, "td")) set_time_offset(result, *td);
  return result;
}

/// Pixels of nerfstudio and instant-ngp begin at the corner of the first one, as COLMAP's do.
Calibration read_nerfstudio(const YamlEntry& root) {
  constexpr double kCenter_px = 0.5;
  Calibration result;
  Camera& camera = result.camera;
  set_size(camera, root, "w", "h");
  const auto model = find(root, "camera_model");
  const auto fisheye = find(root, "is_fisheye");
  const std::string name = model ? text(*model, "a camera model") : "OPENCV";
  const bool equidistant =
      name == "OPENCV_FISHEYE" || (fisheye && text(*fisheye, "true or false") == "true");
  if (!equidistant && name != "OPENCV" && name != "PINHOLE" && name != "SIMPLE_PINHOLE")
    yaml_fail(*model, "OPENCV, OPENCV_FISHEYE, PINHOLE or SIMPLE_PINHOLE");
  check_distortion_is_read(root, std::nullopt, equidistant ? "k1 k2 k3 k4" : "k1 k2 k3 p1 p2");
  const auto focal = find(root, "fl_x");
  const YamlEntry place = focal ? *focal : at(root, "camera_angle_x", "an angle in radians");
  if (!focal || !find(root, "cx")) at_path(root, "w", kPixels);
  const double fx = focal ? number(place) : 0.5 * camera.width / std::tan(0.5 * number(place));
  const auto value = [&](const char* key, double otherwise) {
    const auto entry = find(root, key);
    return entry ? number(*entry) : otherwise;
  };
  set_intrinsics(camera,
                 place,
                 {fx,
                  value("fl_y", fx),
                  value("cx", 0.5 * camera.width) - kCenter_px,
                  value("cy", 0.5 * camera.height) - kCenter_px});
  std::vector<double> k;
  for (const char* key : {"k1", "k2", equidistant ? "k3" : "p1", equidistant ? "k4" : "p2"})
    k.push_back(value(key, 0));
  if (!equidistant && value("k3", 0) != 0) k.push_back(value("k3", 0));
  const bool plain = !equidistant && std::ranges::all_of(k, [](double v) { return v == 0; });
  if (!plain)
    set_lens(
        camera, place, equidistant ? Distortion::equidistant : Distortion::radial_tangential, k);
  return result;
}

Calibration read_nice_slam(const YamlEntry& root) {
  Calibration result;
  set_size(result.camera, root, "camera/w", "camera/h");
  set_named_lens(result.camera, root, "camera/", {"pinhole", Distortion::none, kPinholeKeys, ""});
  const YamlEntry camera = at(root, "camera", "a camera");
  const auto coefficients = find_coefficients(camera);
  check_distortion_is_read(camera, coefficients);
  const auto values = coefficients ? numbers(*coefficients) : std::vector<double>{};
  if (!values.empty())
    set_lens(result.camera, *coefficients, Distortion::radial_tangential, values);
  return result;
}

/// KITTI's calib.txt has 3x4 projection matrices of rectified cameras, calib_cam_to_cam.txt also.
Calibration read_kitti(const YamlEntry& root) {
  Calibration result;
  check_distortion_is_read(root, std::nullopt);
  for (const char* key : {"P_rect_00", "P0", "P1", "P2", "P3"}) {
    const auto entry = find(root, key);
    if (!entry) continue;
    constexpr const char* kExpected = "12 numbers (a 3x4 matrix, row by row)";
    std::vector<double> P;
    const std::string words = text(*entry, kExpected);
    std::string_view rest = trimmed(words);
    while (!rest.empty()) {
      const auto value = parse_number(take_word(rest));
      if (!value) yaml_fail(*entry, kExpected);
      P.push_back(*value);
    }
    if (P.size() != 12) yaml_fail(*entry, counted(P.size(), "number"), kExpected);
    set_intrinsics(result.camera, *entry, {P[0], P[5], P[2], P[6]});
    return result;
  }
  yaml_fail(root, "no projection matrix", "P0");
}

const LensFormat* lens_format_of(const YamlEntry& root) {
  if (!root.node.IsMap()) return nullptr;
  for (const LensFormat& format : lens_formats())
    for (const std::string& key : split(format.keys, ' '))
      if (find_path(root, key)) return &format;
  return nullptr;
}

YamlEntry load_lens_file(const fs::path& file) {
  std::error_code none;
  if (lower_case(file.extension().string()) == ".json" &&
      fs::file_size(file, none) > limits().hand_bytes)
    return without_frames(file);
  return is_xml(file) ? load_opencv_xml(file) : load_yaml(file);
}

}  // namespace gpo
