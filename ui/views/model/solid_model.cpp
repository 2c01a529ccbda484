// Copyright (c) 2026, the gpo-inspector authors
// SPDX-License-Identifier: BSD-3-Clause
#include "ui/views/model/solid_model.h"

#include "engine/base/error.h"
#include "ui/look/palette.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <string_view>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <vtkCellArray.h>
#include <vtkCompositeDataIterator.h>
#include <vtkGLTFReader.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
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

using Eigen::Vector3d;

/// Sorting and projecting so many still leaves a frame in time.
constexpr std::size_t kMostTriangles = 200'000;

/// VTK prints what it does not like of a file; the user is told by the error.
struct Unheard {
  Unheard() { vtkObject::GlobalWarningDisplayOff(); }
  ~Unheard() { vtkObject::SetGlobalWarningDisplay(before); }
  Unheard(const Unheard&) = delete;
  Unheard& operator=(const Unheard&) = delete;

  int before = vtkObject::GetGlobalWarningDisplay();
};

/// What a file has, in its own frame.
struct RawModel {
  std::vector<Vector3d> points;
  std::vector<std::array<int, 3>> triangles;
  std::vector<std::optional<std::uint32_t>> rgb;
};

std::uint32_t mean_rgb(vtkUnsignedCharArray& colors, const std::array<vtkIdType, 3>& corners) {
  std::uint32_t rgb = 0;
  for (int channel = 0; channel < 3; ++channel) {
    unsigned sum = 0;
    for (const vtkIdType corner : corners) sum += colors.GetTypedComponent(corner, channel);
    rgb = (rgb << 8) | (sum / 3);
  }
  return rgb;
}

/// VTK does not hold them against the points that there are.
void check_corners(vtkPolyData& mesh) {
  for (vtkCellArray* cells : {mesh.GetPolys(), mesh.GetStrips()}) {
    vtkIdType count = 0;
    const vtkIdType* ids = nullptr;
    for (cells->InitTraversal(); cells->GetNextCell(count, ids) != 0;)
      for (vtkIdType i = 0; i < count; ++i)
        if (ids[i] < 0 || ids[i] >= mesh.GetNumberOfPoints())
          throw InputError(fmt::format(
              "a triangle's corner is point {} of {}", ids[i] + 1, mesh.GetNumberOfPoints()));
  }
}

void append(RawModel& model, vtkPolyData* mesh) {
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
    const std::array<vtkIdType, 3> corners = {ids[0], ids[1], ids[2]};
    model.triangles.push_back({first + static_cast<int>(corners[0]),
                               first + static_cast<int>(corners[1]),
                               first + static_cast<int>(corners[2])});
    model.rgb.push_back(colors == nullptr ? std::nullopt
                                          : std::optional(mean_rgb(*colors, corners)));
  }
}

template <class Reader>
RawModel read_mesh(const std::string& file) {
  vtkNew<Reader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  RawModel model;
  append(model, reader->GetOutput());
  return model;
}

RawModel read_gltf(const std::string& file) {
  vtkNew<vtkGLTFReader> reader;
  reader->SetFileName(file.c_str());
  reader->Update();
  RawModel model;
  auto* parts = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutputDataObject(0));
  if (parts == nullptr) return model;
  const auto part = vtk::TakeSmartPointer(parts->NewIterator());
  for (part->InitTraversal(); part->IsDoneWithTraversal() == 0; part->GoToNextItem())
    append(model, vtkPolyData::SafeDownCast(part->GetCurrentDataObject()));
  return model;
}

RawModel robot() {
  vtkNew<vtkPLYReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(gpo_robot, gpo_robot_end));
  reader->Update();
  RawModel model;
  append(model, reader->GetOutput());
  return model;
}

struct FileType {
  std::string_view extension;
  bool y_up;
  RawModel (*read)(const std::string& file);
};
constexpr std::array kFileTypes = {FileType{".obj", true, read_mesh<vtkOBJReader>},
                                   FileType{".ply", false, read_mesh<vtkPLYReader>},
                                   FileType{".gltf", true, read_gltf},
                                   FileType{".glb", true, read_gltf}};

/// The axes of files whose y is up: their front, +z, looks at who looks at them.
Vector3d with_z_up(const Vector3d& point) { return {point.x(), -point.z(), point.y()}; }

/// From the viewer's left above, as over the cube.
double light_on(const SolidModel& model, const std::array<int, 3>& triangle) {
  constexpr double kAmbient = 0.5;
  const Vector3d towards_light = Vector3d(-0.35, -0.6, 0.72).normalized();
  const Vector3d &a = model.points[triangle[0]], &b = model.points[triangle[1]];
  const Vector3d& c = model.points[triangle[2]];
  const Vector3d normal = (b - a).cross(c - a).stableNormalized();
  return kAmbient + (1 - kAmbient) * std::max(0.0, normal.dot(towards_light));
}

/// Checked, on its foot, a side wide.
SolidModel stood(RawModel raw, const std::string& name) {
  const auto refuse = [&name](const std::string& why) { throw InputError(name + ": " + why); };
  if (raw.triangles.empty()) refuse("no triangles could be read");
  if (raw.triangles.size() > kMostTriangles)
    refuse(
        fmt::format("{} triangles, at most {} can be shown", raw.triangles.size(), kMostTriangles));
  Eigen::AlignedBox3d box;
  for (const auto& triangle : raw.triangles)
    for (const int corner : triangle) box.extend(raw.points[corner]);
  const double width = std::max(box.sizes().x(), box.sizes().y());
  if (!box.sizes().allFinite() || !(width > 0)) refuse("its points have no finite extent");
  const Vector3d foot(box.center().x(), box.center().y(), box.min().z());
  for (Vector3d& point : raw.points) point = (point - foot) / width;
  SolidModel model{.points = std::move(raw.points),
                   .triangles = std::move(raw.triangles),
                   .rgb = std::move(raw.rgb),
                   .light = {},
                   .height_sides = box.sizes().z() / width};
  for (const auto& triangle : model.triangles) model.light.push_back(light_on(model, triangle));
  return model;
}

std::string lower_extension(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

}  // namespace

SolidModel read_solid_model(const std::string& name) {
  if (name == "robot") return stood(robot(), name);
  const auto type =
      std::ranges::find(kFileTypes, std::string_view(lower_extension(name)), &FileType::extension);
  if (type == kFileTypes.end()) throw InputError(name + ": expected .obj, .ply, .gltf or .glb");
  std::error_code none;
  if (!std::filesystem::is_regular_file(name, none)) throw InputError(name + ": no such file");
  RawModel raw;
  try {
    const Unheard messages;
    raw = type->read(name);
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
  if (type->y_up) std::ranges::transform(raw.points, raw.points.begin(), with_z_up);
  return stood(std::move(raw), name);
}

std::vector<Vector3d> placed_on(const SolidModel& model,
                                const std::array<Vector3d, 8>& cube_corners_w) {
  const auto& corner = cube_corners_w;
  const Vector3d middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
  // x cross y of the cube's edges points into the plane: the model's y is the other way.
  Eigen::Matrix3d axes;
  axes << corner[1] - corner[0], corner[0] - corner[2], corner[4] - corner[0];
  std::vector<Vector3d> placed;
  placed.reserve(model.points.size());
  for (const Vector3d& point : model.points) placed.emplace_back(middle + axes * point);
  return placed;
}

double light_above_ground(double height_sides) {
  constexpr double kAtFoot = 0.6;
  const double height = std::clamp(height_sides, 0.0, 1.0);
  return kAtFoot + (1 - kAtFoot) * (1 - (1 - height) * (1 - height));
}

std::uint32_t lit_rgb(const SolidModel& model,
                      std::size_t triangle,
                      std::uint32_t cube_rgb,
                      double above_ground) {
  return mixed_rgb(0, model.rgb[triangle].value_or(cube_rgb), model.light[triangle] * above_ground);
}

}  // namespace gpo
