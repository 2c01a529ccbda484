// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/model/solid_model.h"

#include "engine/base/error.h"
#include "engine/files/text_file.h"
#include "ui/context/vtk_window.h"
#include "ui/look/look.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>
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

/// Sorting and projecting more takes too long for a frame.
constexpr std::size_t kMostTriangles = 200'000;

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

struct FileType {
  std::string_view extension;
  bool y_up;
  SolidModel (*read)(const std::string& file);
};
constexpr std::array kFileTypes = {FileType{".obj", true, read_mesh<vtkOBJReader>},
                                   FileType{".ply", false, read_mesh<vtkPLYReader>},
                                   FileType{".gltf", true, read_mesh<vtkGLTFReader>},
                                   FileType{".glb", true, read_mesh<vtkGLTFReader>}};

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
  if (model.triangles.size() > kMostTriangles)
    refuse(fmt::format(
        "it has {} triangles, at most {} can be shown", model.triangles.size(), kMostTriangles));
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
