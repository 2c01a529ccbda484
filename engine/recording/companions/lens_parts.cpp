// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "engine/geometry/decompositions.h"
#include "engine/recording/companions/lens_formats.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>
#include <fmt/format.h>

namespace gpo {
namespace {

constexpr double kMostShift_s = 3600;
/// From one image in 100 s to a high-speed camera, so that time stamps fit and differ.
constexpr double kLeastImageRate_hz = 0.01;
constexpr double kMostImageRate_hz = 100'000;

std::string counts_text(const std::vector<std::size_t>& counts) {
  std::string text;
  for (std::size_t i = 0; i < counts.size(); ++i)
    text += fmt::format("{}{}", i == 0 ? "" : i + 1 < counts.size() ? ", " : " or ", counts[i]);
  return text;
}

/// Spellings in lower case without underscores, in the order of their precedence.
constexpr const char* kCoefficientKeys =
    "distortioncoefficients distortioncoeffs distortioncoefs distortioncoefficient distortioncoeff "
    "distortioncoef distcoeffs distcoefs distcoefficients distcoeff distcoef distcoefficient "
    "distortionvector coefficients coeffs distortion d d1 dist";
/// Keys of every format that describe a distortion and are read elsewhere.
constexpr const char* kReadElsewhere = "distortion_model distortion_coefficients_sigma";

std::string plain_key(const std::string& key) {
  std::string plain = lower_case(key);
  std::erase(plain, '_');
  return plain;
}

bool is_one_of(const std::string& names, const std::string& name) {
  return std::ranges::count(split(names, ' '), name) > 0;
}

/// Returns whether a key's name announces a distortion; `min_dist` of VINS and distances do not.
bool names_distortion(const std::string& key) {
  const std::string name = lower_case(key);
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  if (has("distance") || has("distribut") || name == "min_dist" || name == "max_dist") return false;
  return has("dist") || has("coef") || is_one_of("k1 k2 k3 k4 p1 p2", key);
}

/// Returns whether a value states that there is no distortion.
bool is_no_distortion(const YAML::Node& node) {
  const auto is_none = [](const auto& item) { return is_no_distortion(item); };
  if (node.IsScalar())
    return is_one_of("none no false ~ null", lower_case(node.Scalar())) || node.Scalar().empty() ||
           parse_number(node.Scalar()) == 0.0;
  if (node.IsSequence()) return std::all_of(node.begin(), node.end(), is_none);
  if (!node.IsMap()) return true;
  if (const YAML::Node data = node["data"]) return is_no_distortion(data);
  return std::all_of(
      node.begin(), node.end(), [](const auto& item) { return is_no_distortion(item.second); });
}

}  // namespace

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

void set_coefficients(Camera& camera, const YamlEntry& entry, std::vector<double> values) {
  const LensModel& model = lens_model(camera.distortion);
  if (camera.distortion == Distortion::none) {
    if (std::ranges::any_of(values, [](double k) { return k != 0; }))
      yaml_fail(entry, counted(values.size(), "number"), "none for distortion model none");
    return;
  }
  if (std::ranges::count(model.counts, values.size()) == 0)
    yaml_fail(entry,
              counted(values.size(), "number"),
              fmt::format("{} ({}) for distortion model {}",
                          counts_text(model.counts),
                          model.coefficients,
                          model.name));
  if (!are_coefficients(values))
    yaml_fail(entry, "an implausible coefficient", "magnitudes of the order of 1");
  camera.coefficients = std::move(values);
  if (const auto fault = coefficient_fault(camera))
    yaml_fail(entry, *fault, fmt::format("a lens of the model {}", model.name));
}

std::optional<YamlEntry> find_coefficients(const YamlEntry& map) {
  if (!map.node.IsMap()) return std::nullopt;
  for (const std::string& name : split(kCoefficientKeys, ' '))
    for (const auto& item : map.node)
      if (item.first.IsScalar() && plain_key(item.first.Scalar()) == name)
        return below(map, item.first.Scalar(), item.second);
  return std::nullopt;
}

void check_distortion_is_read(const YamlEntry& map,
                              const std::optional<YamlEntry>& read,
                              const std::string& others) {
  if (!map.node.IsMap()) return;
  for (const auto& item : map.node) {
    if (!item.first.IsScalar()) continue;
    const std::string& key = item.first.Scalar();
    const bool known = (read && item.second.is(read->node)) || is_one_of(others, key) ||
                       is_one_of(kReadElsewhere, key);
    if (!known && names_distortion(key) && !is_no_distortion(item.second))
      yaml_fail(below(map, key, item.second),
                "a distortion that is not read",
                "the key `distortion_coefficients` or the keys of the file's format");
  }
}

void convert_focal_lengths(Camera& camera) {
  double slope = 1;
  if (camera.distortion == Distortion::double_sphere ||
      camera.distortion == Distortion::omnidirectional)
    slope = 1 / (1 + camera.coefficients[0]);
  if (camera.distortion == Distortion::field_of_view && camera.coefficients[0] > 0)
    slope = 2 * std::tan(camera.coefficients[0] / 2) / camera.coefficients[0];
  camera.fx *= slope;
  camera.fy *= slope;
}

void set_time_offset(Calibration& calibration, const YamlEntry& entry) {
  const double seconds = number(entry);
  if (std::abs(seconds) > kMostShift_s) yaml_fail(entry, "seconds, at most 3600");
  calibration.time_offset_ns = std::llround(seconds * 1e9);
}

void set_rate(Calibration& calibration, const YamlEntry& rate) {
  calibration.rate_hz = number(rate);
  if (!is_image_rate(*calibration.rate_hz))
    yaml_fail(rate,
              fmt::format("{} to {:.0f} images per second", kLeastImageRate_hz, kMostImageRate_hz));
}

Pose rigid_motion_of(const YamlEntry& entry, const Eigen::Matrix4d& T) {
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  constexpr double kTolerance = 1e-2;  // for files with few digits
  const Eigen::Array33d skew = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs();
  if (!(skew <= kTolerance).all() || R.determinant() < 0)
    yaml_fail(entry, "a matrix that is no rotation", "an orthonormal right-handed 3x3 part");
  if (T.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    yaml_fail(entry, "another last row", "0, 0, 0, 1");
  return {nearest_rotation(R), T.topRightCorner<3, 1>()};
}

Pose rigid_motion(const YamlEntry& entry) {
  const auto values = numbers(entry, 16, "16 (a 4x4 matrix, row by row)");
  return rigid_motion_of(
      entry, Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data()));
}

bool is_image_rate(double rate_hz) {
  return rate_hz >= kLeastImageRate_hz && rate_hz <= kMostImageRate_hz;
}

}  // namespace gpo
