// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/model/solid_model.h"

#include "engine/base/error.h"
#include "engine/files/byte_cursor.h"
#include "engine/files/refuse.h"
#include "engine/files/text_file.h"
#include "ui/context/vtk_window.h"
#include "ui/look/look.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkGLTFReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkTriangleFilter.h>
#include <vtkUnsignedCharArray.h>

// assets/assets.S
extern "C" {
extern const char gpo_robot[], gpo_robot_end[];
}

namespace gpo {
namespace {

std::uint32_t mean_rgb(vtkUnsignedCharArray& colors, const vtkIdType* corners) {
  std::uint32_t rgb = 0;
  for (int channel = 0; channel < 3; ++channel) {
    unsigned sum = 0;
    for (int k = 0; k < 3; ++k) sum += colors.GetTypedComponent(corners[k], channel);
    rgb = (rgb << 8) | (sum / 3);
  }
  return rgb;
}

/// Throws if a corner is not a point: VTK does not check this.
void check_corners(vtkPolyData& mesh) {
  for (vtkCellArray* cells : {mesh.GetPolys(), mesh.GetStrips()}) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    for (cells->InitTraversal(); cells->GetNextCell(count, ids) != 0;)
      for (vtkIdType i = 0; i < count; ++i)
        if (ids[i] < 0 || ids[i] >= mesh.GetNumberOfPoints())
          throw InputError(fmt::format(
              "a triangle refers to point {} of {}", ids[i] + 1, mesh.GetNumberOfPoints()));
  }
}

void append(SolidModel& model, vtkPolyData* mesh) {
  if (mesh == nullptr || mesh->GetPoints() == nullptr) return;
  check_corners(*mesh);
  vtkNew<vtkTriangleFilter> split;
  split->SetInputData(mesh);
  split->PassVertsOff();
  split->PassLinesOff();
  split->Update();
  vtkPolyData* triangles = split->GetOutput();
  const auto first = static_cast<int>(model.points.size());
  for (vtkIdType i = 0; i < triangles->GetNumberOfPoints(); ++i)
    model.points.emplace_back(triangles->GetPoint(i));
  auto* colors = vtkUnsignedCharArray::SafeDownCast(triangles->GetPointData()->GetArray("RGB"));
  vtkCellArray* cells = triangles->GetPolys();
  vtkIdType count = 0;
  const vtkIdType* ids = nullptr;
  for (cells->InitTraversal(); cells->GetNextCell(count, ids) != 0;) {
    if (count != 3) continue;
    auto& corners = model.triangles.emplace_back();
    for (int k = 0; k < 3; ++k) corners[k] = first + static_cast<int>(ids[k]);
    model.rgb.push_back(colors ? std::optional(mean_rgb(*colors, ids)) : std::nullopt);
  }
}

SolidModel model_of(vtkAlgorithm& reader) {
  reader.Update();
  vtkDataObject* output = reader.GetOutputDataObject(0);
  SolidModel model;
  append(model, vtkPolyData::SafeDownCast(output));
  auto* parts = vtkMultiBlockDataSet::SafeDownCast(output);
  if (parts == nullptr) return model;
  const auto part = vtk::TakeSmartPointer(parts->NewIterator());
  for (part->InitTraversal(); part->IsDoneWithTraversal() == 0; part->GoToNextItem())
    append(model, vtkPolyData::SafeDownCast(part->GetCurrentDataObject()));
  return model;
}

template <class Reader>
SolidModel read_mesh(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  return model_of(*reader);
}

SolidModel robot() {
  vtkNew<vtkPLYReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(gpo_robot, gpo_robot_end));
  return model_of(*reader);
}

/// Throws InputError for a claimed number of points, corners or faces that VTK would allocate.
void check_claim(const std::string& file, const char* things, double count) {
  const auto most = static_cast<double>(3 * limits().triangles);
  if (count <= most) return;
  refuse_size(file, fmt::format("{} {}", count, things), fmt::format("at most {}", most));
}

void check_ply(const std::string& file, std::string_view content) {
  TextLines lines(content);
  bool binary = false;
  for (auto line = lines.next(); line && *line != "end_header"; line = lines.next()) {
    const std::string_view key = take_word(*line), kind = take_word(*line);
    if (key == "format") binary = kind != "ascii";
    if (key == "element") check_claim(file, "elements", parse_number(*line).value_or(0));
    // VTK allocates as many corners as a face claims.
    const bool long_count = line->starts_with("int") || line->starts_with("uint");
    if (key == "property" && kind == "list" && binary && long_count && !line->starts_with("int8") &&
        !line->starts_with("uint8"))
      refuse(file, "found a list with counts of type {}, expected uchar", take_word(*line));
  }
}

/// Checks the numbers of a glTF file, or of the JSON in front of a binary one.
void check_gltf(const std::string& file, std::string_view content) {
  constexpr std::size_t kHead = 20;  // length of both headers
  if (content.starts_with("glTF")) {
    const std::uint64_t length = little_endian(content, 12, 4);
    content = content.substr(std::min(kHead, content.size())).substr(0, length);
  }
  const auto json = parse_json(content);
  if (!json.is_object()) refuse(file, "found no glTF");
  const auto check = [&](const char* list, const char* key, auto&& check_value) {
    if (!json.contains(list) || !json[list].is_array()) return;
    for (const auto& one : json[list])
      if (one.is_object() && one.contains(key) && one[key].is_number())
        check_value(one[key].template get<double>());
  };
  check("accessors", "count", [&](double count) { check_claim(file, "values", count); });
  check("buffers", "byteLength", [&](double bytes) {
    if (bytes > static_cast<double>(limits().model_bytes))
      refuse_size(file, fmt::format("a buffer of {} bytes", bytes), "a smaller one");
  });
}

struct FileType {
  std::string_view extension;
  bool y_up;
  SolidModel (*read)(const std::string& file);
  void (*check)(const std::string& file, std::string_view content) = nullptr;
};
constexpr std::array kFileTypes = {FileType{".obj", true, read_mesh<vtkOBJReader>},
                                   FileType{".ply", false, read_mesh<vtkPLYReader>, check_ply},
                                   FileType{".gltf", true, read_mesh<vtkGLTFReader>, check_gltf},
                                   FileType{".glb", true, read_mesh<vtkGLTFReader>, check_gltf}};

/// Converts the axes of files whose y is up: their front, +z, faces the viewer.
Vector3d with_z_up(const Vector3d& point) { return {point.x(), -point.z(), point.y()}; }

/// Returns the light on a triangle, from the viewer's upper left, as for the cube.
double light_on(const SolidModel& model, const std::array<int, 3>& triangle) {
  constexpr double kAmbient = 0.5;
  const Vector3d towards_light = Vector3d(-0.35, -0.6, 0.72).normalized();
  const Vector3d &a = model.points[triangle[0]], &b = model.points[triangle[1]];
  const Vector3d& c = model.points[triangle[2]];
  const Vector3d normal = (b - a).cross(c - a).stableNormalized();
  return kAmbient + (1 - kAmbient) * std::max(0.0, normal.dot(towards_light));
}

/// Checks the model of a file and moves it into the frame of `SolidModel`.
SolidModel normalized(SolidModel model, const std::string& name) {
  const auto refuse = [&name](const std::string& why) { throw InputError(name + ": " + why); };
  if (model.triangles.empty()) refuse("no triangles found");
  if (model.triangles.size() > limits().triangles)
    refuse(fmt::format("it has {} triangles, at most {} can be shown; --limits allows more",
                       model.triangles.size(),
                       limits().triangles));
  Eigen::AlignedBox3d box;
  for (const auto& triangle : model.triangles)
    for (const int corner : triangle) box.extend(model.points[corner]);
  const double width = std::max(box.sizes().x(), box.sizes().y());
  if (!box.sizes().allFinite() || !(width > 0)) refuse("its points have no finite extent");
  const Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  for (Vector3d& point : model.points) point = (point - foot) / width;
  model.height_sides = box.sizes().z() / width;
  for (const auto& triangle : model.triangles) model.light.push_back(light_on(model, triangle));
  return model;
}

}  // namespace

SolidModel read_solid_model(const std::string& name) {
  if (name == "robot") return normalized(robot(), name);
  const std::string extension = lower_case(std::filesystem::path(name).extension().string());
  const auto type = std::ranges::find(kFileTypes, extension, &FileType::extension);
  if (type == kFileTypes.end()) throw InputError(name + ": expected .obj, .ply, .gltf or .glb");
  std::error_code none;
  if (!std::filesystem::is_regular_file(name, none)) throw InputError(name + ": no such file");
  const std::string content = read_file(name, limits().model_bytes);
  if (type->check != nullptr) type->check(name, content);
  SolidModel model;
  try {
    const VtkMessages dropped;  // the error reports a bad file
    model = type->read(name);
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
  if (type->y_up) std::ranges::transform(model.points, model.points.begin(), with_z_up);
  return normalized(std::move(model), name);
}

std::vector<Vector3d> placed_on(const SolidModel& model, const CubeCorners& cube_corners_w) {
  const auto& corner = cube_corners_w;
  const Vector3d middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
  // x cross y of the cube's edges points into the plane: the model's y is opposite.
  Eigen::Matrix3d axes;
  axes << corner[1] - corner[0], corner[0] - corner[2], corner[4] - corner[0];
  std::vector<Vector3d> placed;
  for (const Vector3d& point : model.points) placed.emplace_back(middle + axes * point);
  return placed;
}

double light_above_ground(double height_sides, double at_foot) {
  const double depth = 1 - std::clamp(height_sides, 0.0, 1.0);
  return at_foot + (1 - at_foot) * (1 - depth * depth);
}

std::uint32_t lit_rgb(const SolidModel& model,
                      std::size_t triangle,
                      std::uint32_t cube_rgb,
                      double above_ground) {
  return mixed_rgb(0, model.rgb[triangle].value_or(cube_rgb), model.light[triangle] * above_ground);
}

}  // namespace gpo
