// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
// Lens files without keys: COLMAP's cameras, ETH3D's four numbers and the text of ROS.
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "engine/recording/companions/lens_formats.h"

#include <algorithm>
#include <map>

namespace gpo {
namespace {

/// A camera model of COLMAP; the numbers of coefficients are those of the file.
struct ColmapModel {
  const char* name;
  int focal_lengths;
  int coefficients;
  Distortion distortion;
};
/// In the order of COLMAP's numbers of the models, from 0.
constexpr auto kColmapModels =
    std::to_array<ColmapModel>({{"SIMPLE_PINHOLE", 1, 0, Distortion::none},
                                {"PINHOLE", 2, 0, Distortion::none},
                                {"SIMPLE_RADIAL", 1, 1, Distortion::radial_tangential},
                                {"RADIAL", 1, 2, Distortion::radial_tangential},
                                {"OPENCV", 2, 4, Distortion::radial_tangential},
                                {"OPENCV_FISHEYE", 2, 4, Distortion::equidistant},
                                {"FULL_OPENCV", 2, 8, Distortion::radial_tangential},
                                {"FOV", 2, 1, Distortion::field_of_view},
                                {"SIMPLE_RADIAL_FISHEYE", 1, 1, Distortion::equidistant},
                                {"RADIAL_FISHEYE", 1, 2, Distortion::equidistant},
                                {"THIN_PRISM_FISHEYE", 2, 8, Distortion::thin_prism_fisheye}});

constexpr const char* kOneCamera = "one camera for all images";

std::size_t parameter_count(const ColmapModel& model) {
  return static_cast<std::size_t>(model.focal_lengths + 2 + model.coefficients);
}

/// Places in messages; a table has no keys.
YamlEntry table_place(const fs::path& file) { return {file, "", YAML::Node()}; }

/// COLMAP's pixels begin at the corner of the first one.
Calibration colmap_camera(const fs::path& file,
                          const ColmapModel& model,
                          const std::array<double, 2>& size,
                          const std::vector<double>& parameters) {
  constexpr double kCenter_px = 0.5;
  const YamlEntry place = table_place(file);
  Calibration result;
  Camera& camera = result.camera;
  set_resolution(camera, place, size[0], size[1]);
  const auto after = parameters.begin() + model.focal_lengths;
  set_intrinsics(camera,
                 place,
                 {parameters[0],
                  parameters[model.focal_lengths - 1],
                  after[0] - kCenter_px,
                  after[1] - kCenter_px});
  if (model.coefficients == 0) return result;
  std::vector<double> coefficients(after + 2, parameters.end());
  if (model.distortion != Distortion::field_of_view)
    coefficients.resize(std::max(coefficients.size(), std::size_t{4}));
  camera.distortion = model.distortion;
  set_coefficients(camera, place, std::move(coefficients));
  convert_focal_lengths(camera);
  return result;
}

/// Returns the lines without comments and empty ones.
std::vector<std::string_view> data_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  TextLines all(text);
  while (const auto line = all.next())
    if (!line->empty() && line->front() != '#') lines.push_back(*line);
  return lines;
}

std::string_view first_line(std::string_view text) {
  TextLines all(text);
  while (const auto line = all.next())
    if (!line->empty() && line->front() != '#') return *line;
  return {};
}

std::vector<double> numbers_in(std::string_view line) {
  std::vector<double> values;
  while (!line.empty()) {
    const auto value = parse_number(take_word(line));
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

bool is_colmap_text(const fs::path& /*file*/, std::string_view bytes) {
  std::string_view line = first_line(bytes.substr(0, limits().hand_bytes));
  if (!parse_integer(take_word(line))) return false;
  const std::string_view model = take_word(line);
  const auto is_name = [](char c) { return (c >= 'A' && c <= 'Z') || c == '_'; };
  constexpr std::size_t kLongestName = 40;
  return !model.empty() && model.size() < kLongestName && std::ranges::all_of(model, is_name) &&
         numbers_in(line).size() >= 5;
}

Calibration read_colmap_text(const fs::path& file, std::string_view bytes) {
  const auto lines = data_lines(bytes);
  if (lines.size() > 1) fail_at(file, fmt::format("{} cameras", lines.size()), kOneCamera);
  std::string_view line = lines.front();
  take_word(line);
  const std::string name(take_word(line));
  const auto model = std::ranges::find(kColmapModels, name, &ColmapModel::name);
  if (model == kColmapModels.end())
    fail_at(file, "the camera model " + name, "one that COLMAP documents up to THIN_PRISM_FISHEYE");
  std::vector<double> values = numbers_in(line);
  if (values.size() != 2 + parameter_count(*model))
    fail_at(
        file,
        counted(values.size(), "number"),
        fmt::format("{} for {} (width, height, parameters)", 2 + parameter_count(*model), name));
  return colmap_camera(file, *model, {values[0], values[1]}, {values.begin() + 2, values.end()});
}

bool is_colmap_binary(const fs::path& file, std::string_view /*bytes*/) {
  return file.filename() == "cameras.bin";
}

Calibration read_colmap_binary(const fs::path& file, std::string_view bytes) {
  ByteCursor cursor(bytes);
  const auto count = cursor.number<std::uint64_t>();
  if (cursor.ok() && count != 1) fail_at(file, fmt::format("{} cameras", count), kOneCamera);
  cursor.number<std::uint32_t>();  // id
  const auto number = cursor.number<std::uint32_t>();
  if (cursor.ok() && number >= kColmapModels.size())
    fail_at(file,
            fmt::format("camera model {}", number),
            fmt::format("0 to {}", kColmapModels.size() - 1));
  const auto width = static_cast<double>(cursor.number<std::uint64_t>());
  const auto height = static_cast<double>(cursor.number<std::uint64_t>());
  std::vector<double> parameters;
  if (cursor.ok()) {
    parameters.resize(parameter_count(kColmapModels[number]));
    for (double& value : parameters) value = cursor.number<double>();
  }
  if (!cursor.ok()) fail_at(file, counted(bytes.size(), "byte"), "a camera of COLMAP");
  if (!std::ranges::all_of(parameters, [](double v) { return std::isfinite(v); }))
    fail_at(file, "a parameter that is not finite", "numbers");
  return colmap_camera(file, kColmapModels[number], {width, height}, parameters);
}

/// ETH3D's calibration.txt: "fx fy cx cy".
bool is_four_numbers(const fs::path& /*file*/, std::string_view bytes) {
  constexpr std::size_t kLongest = 1000;
  return bytes.size() < kLongest && data_lines(bytes).size() == 1 &&
         numbers_in(first_line(bytes)).size() == 4;
}

Calibration read_four_numbers(const fs::path& file, std::string_view bytes) {
  const auto k = numbers_in(first_line(bytes));
  Calibration result;
  set_intrinsics(result.camera, table_place(file), {k[0], k[1], k[2], k[3]});
  return result;
}

constexpr const char* kRosMatrix = "camera matrix";

/// The text (ost.txt, *.ini) of ROS' camera_calibration: numbers below headings without a colon.
bool is_ros_text(const fs::path& /*file*/, std::string_view bytes) {
  const auto lines = data_lines(bytes.substr(0, limits().hand_bytes));
  return std::ranges::count(lines, kRosMatrix) > 0;
}

Calibration read_ros_text(const fs::path& file, std::string_view bytes) {
  std::map<std::string, std::vector<double>> below_heading;
  std::string heading;
  int cameras = 0;
  for (const std::string_view line : data_lines(bytes)) {
    const auto values = numbers_in(line);
    if (values.empty()) {
      heading = line;
      cameras += heading == kRosMatrix;
    }
    auto& all = below_heading[heading];
    all.insert(all.end(), values.begin(), values.end());
  }
  if (cameras > 1) fail_at(file, fmt::format("{} cameras", cameras), kOneCamera);
  const auto values_of = [&](const char* name) {
    return std::pair(YamlEntry{file, name, YAML::Node()}, below_heading[name]);
  };
  Calibration result;
  Camera& camera = result.camera;
  const auto [width_place, width] = values_of("width");
  const auto [height_place, height] = values_of("height");
  if (width.size() != 1) yaml_fail(width_place, counted(width.size(), "number"), "1");
  if (height.size() != 1) yaml_fail(height_place, counted(height.size(), "number"), "1");
  set_resolution(camera, width_place, width[0], height[0]);
  const auto [matrix_place, k] = values_of(kRosMatrix);
  if (k.size() != 9) yaml_fail(matrix_place, counted(k.size(), "number"), "9 (a 3x3 matrix)");
  set_intrinsics(camera, matrix_place, {k[0], k[4], k[2], k[5]});
  const auto [place, coefficients] = values_of("distortion");
  // The fisheye lens has 4, and the file does not name the model.
  if (coefficients.size() != 5 && coefficients.size() != 8)
    yaml_fail(place,
              counted(coefficients.size(), "number"),
              "5 or 8 of a lens that is no fisheye. Use the YAML file of the calibration");
  camera.distortion = Distortion::radial_tangential;
  set_coefficients(camera, place, coefficients);
  return result;
}

constexpr auto kTables = std::to_array<LensTable>({{"COLMAP", is_colmap_binary, read_colmap_binary},
                                                   {"COLMAP", is_colmap_text, read_colmap_text},
                                                   {"ETH3D", is_four_numbers, read_four_numbers},
                                                   {"ROS", is_ros_text, read_ros_text}});

}  // namespace

const LensTable* lens_table_of(const fs::path& file, std::string_view bytes) {
  const auto found =
      std::ranges::find_if(kTables, [&](const LensTable& one) { return one.is(file, bytes); });
  return found == kTables.end() ? nullptr : &*found;
}

}  // namespace gpo
